// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/radiometry/spectrum.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "imaging/radiometry/radiometry.hpp"

namespace meltproof::imaging {
namespace {

const Spectrum flat({3e-6, 5e-6}, {1, 1}, "flat");

TEST(Spectrum, FlatIsTheFlatBand) {
  for (const double t : {300.0, 1000.0, 1673.15, 2500.0})
    EXPECT_NEAR(weighted_radiance(flat, t) / band_radiance(3e-6, 5e-6, t), 1, 1e-9) << t;
  EXPECT_NEAR(weighted_radiance(flat, 1673.15), 33070.1, 0.1);
  EXPECT_EQ(weighted_radiance(flat, 0), 0);
}

// A narrow triangle is a line: its radiance is Planck's law there times its area.
TEST(Spectrum, NarrowIsPlancksLaw) {
  const double width = 1e-9, lambda = 4e-6, t = 1683;
  const Spectrum line({lambda - width, lambda, lambda + width}, {0, 1, 0}, "line");
  const double h = 6.62607015e-34, c = 299792458, k = 1.380649e-23;
  const double planck = 2 * h * c * c / std::pow(lambda, 5) / std::expm1(h * c / (lambda * k * t));
  EXPECT_NEAR(weighted_radiance(line, t) / (planck * width), 1, 1e-6);
}

TEST(Spectrum, InvertsToAMicrokelvin) {
  const Spectrum rising({3e-6, 4e-6, 5e-6}, {0.2, 0.9, 0.4}, "rising");
  for (double t = 300; t < 5000; t *= 1.3)
    EXPECT_NEAR(weighted_temperature(rising, weighted_radiance(rising, t)), t,
                1e-6 * (1 + t / 1000));
  EXPECT_TRUE(std::isnan(weighted_temperature(rising, -1)));
}

TEST(Spectrum, OfAWindowTransmitsItsMean) {
  const Spectrum grey({2e-6, 6e-6}, {0.313, 0.313}, "grey");
  EXPECT_NEAR(effective_transmission(flat, grey, 1673.15), 0.313, 1e-9);
  // A window that opens towards long waves transmits more of a colder body.
  const Spectrum edge({3e-6, 5e-6}, {0, 1}, "edge");
  EXPECT_GT(effective_transmission(flat, edge, 800), effective_transmission(flat, edge, 2500));
}

TEST(Spectrum, ReplacesTheBandInTheSignal) {
  Radiometry r;
  r.transmission = 0.313;
  r.emissivity = 0.3;
  const double without = signal(r, 1673.15);
  r.spectrum = std::make_shared<Spectrum>(flat);
  EXPECT_NEAR(signal(r, 1673.15) / without, 1, 1e-9);
  EXPECT_NEAR(temperature(r, without), 1673.15, 1e-5);
}

class SpectrumFile : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& text) {
    path_ = std::filesystem::path(testing::TempDir()) / "meltproof_spectrum.csv";
    std::ofstream(path_) << text;
    return path_;
  }
  void TearDown() override { std::filesystem::remove(path_); }
  void expect_refusal(const std::string& text, const std::string& said) {
    try {
      read_spectrum(file(text));
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
    }
  }
  std::filesystem::path path_;
};

TEST_F(SpectrumFile, IsReadWithItsUnits) {
  const Spectrum s =
      read_spectrum(file("# ZnS\nwavelength [nm],transmission [%]\n3000,70\n5000,75\n"));
  EXPECT_NEAR(s.lower(), 3e-6, 1e-18);
  EXPECT_NEAR(s.at(4e-6), 0.725, 1e-12);
  EXPECT_EQ(s.at(6e-6), 0);
}

TEST_F(SpectrumFile, IsRefusedInASentence) {
  expect_refusal("wavelength,transmission\n3,0.7\n", "no unit that is known");
  expect_refusal("wavelength [um],transmission [1]\n3,abc\n", "line 2");
  expect_refusal("wavelength [um],transmission [1]\n3,0.7\n", "two points or more");
  expect_refusal("wavelength [um],transmission [1]\n4,0.7\n3,0.7\n", "increase");
  expect_refusal("wavelength [um],transmission [1]\n3,-0.7\n4,1\n", "zero or more");
}

}  // namespace
}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/radiometry/radiometry.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace meltproof::imaging {
namespace {

constexpr double lower = 3e-6, upper = 5e-6;

TEST(BandRadiance, FlatThreeToFiveMicrometresMatchesIndependentValues) {
  EXPECT_NEAR(band_radiance(lower, upper, 300), 1.86596, 1e-5);
  EXPECT_NEAR(band_radiance(lower, upper, 1000), 6506.73, 1e-2);
  EXPECT_NEAR(band_radiance(lower, upper, 1673.15), 33070.1, 0.1);
  EXPECT_NEAR(band_radiance(lower, upper, 2500), 81814, 1);
}

TEST(BandRadiance, WideBandIsStefanBoltzmann) {
  const double sigma = 5.670374419e-8;
  EXPECT_NEAR(band_radiance(0.1e-6, 20e-3, 1673.15) * M_PI / (sigma * std::pow(1673.15, 4)), 1,
              1e-7);
}

TEST(BandRadiance, NothingRadiatesAtZeroAndAnEmptyBandIsRefused) {
  EXPECT_EQ(band_radiance(lower, upper, 0), 0);
  EXPECT_EQ(band_radiance(lower, upper, 1), 0);  // underflows, without an error
  EXPECT_THROW(band_radiance(upper, lower, 300), InputError);
  EXPECT_THROW(band_radiance(0, lower, 300), InputError);
}

// What an uncorrected reading makes of the reference temperature behind the paper's windows.
TEST(Temperature, UncorrectedReadingsOfThePapersWindows) {
  Radiometry scene;
  scene.transmission = 0.3130;
  scene.emissivity = 1;
  Radiometry blind;  // assumes a black body and no window
  EXPECT_NEAR(temperature(blind, signal(scene, 1673.15)), 1135.00, 0.005);
  scene.emissivity = 0.3;
  EXPECT_NEAR(temperature(blind, signal(scene, 1673.15)), 837.43, 0.005);
  EXPECT_NEAR(temperature(scene, signal(scene, 1673.15)), 1673.15, 1e-6);
}

// Every term once, with the radiances of the first test.
TEST(Signal, IsTheStatedEquation) {
  Radiometry r;
  r.transmission = 0.313;
  r.emissivity = 0.3;
  r.gain = 4e4;
  r.dark = 512;
  r.ambient_temperature = 300;
  r.integration_time = 20e-6;
  EXPECT_NEAR(signal(r, 1000), 4e4 * 20e-6 * 0.313 * (0.3 * 6506.73 + 0.7 * 1.86596) + 512, 1e-3);
  EXPECT_NEAR(signal(r, 1000, 0.2), 4e4 * 20e-6 * 0.313 * (0.2 * 6506.73 + 0.8 * 1.86596) + 512,
              1e-3);
}

TEST(Temperature, OnePercentOfSignalIsSixAndAHalfKelvin) {
  Radiometry r;
  EXPECT_NEAR(temperature(r, 1.01 * signal(r, 1673)) - 1673, 6.5, 0.1);
}

TEST(Temperature, InvertsTheWholeEquationToAMicrokelvin) {
  Radiometry r;
  r.transmission = 0.313;
  r.emissivity = 0.3;
  r.gain = 3.7e4;
  r.dark = 512;
  r.ambient_temperature = 300;
  r.window_temperature = 330;
  r.integration_time = 20e-6;
  for (const bool window : {false, true}) {
    r.window_emission = window;
    const BandTable band(r.band_lower, r.band_upper);
    for (double t = 300; t < 6000; t *= 1.07) {
      EXPECT_NEAR(temperature(r, signal(r, t)), t, 1e-6);
      EXPECT_NEAR(temperature(r, band, signal(r, t)), t, 1e-6);
      EXPECT_NEAR(signal(r, band, t, r.emissivity) / signal(r, t), 1, 1e-9);
    }
  }
}

TEST(Temperature, WindowEmissionIsAnOptionThatAddsItsShare) {
  Radiometry r;
  r.transmission = 0.313;
  r.window_temperature = 350;
  const double without = signal(r, 400);
  r.window_emission = true;
  EXPECT_NEAR(signal(r, 400) - without, (1 - 0.313) * band_radiance(lower, upper, 350), 1e-9);
}

TEST(Temperature, SignalBelowDarkHasNone) {
  Radiometry r;
  r.dark = 100;
  EXPECT_TRUE(std::isnan(temperature(r, 99)));
  EXPECT_TRUE(std::isnan(temperature(r, BandTable(lower, upper), 100)));
  r.emissivity = 0;
  EXPECT_THROW(temperature(r, 200), InputError);
}

TEST(BandTable, AgreesWithTheQuadratureInsideAndOutside) {
  for (const double top : {5e-6, 14e-6}) {
    const BandTable table(lower, top);
    for (double t = 120; t < 12000; t *= 1.013) {
      const double l = band_radiance(lower, top, t);
      EXPECT_NEAR(table.radiance(t) / l, 1, 1e-9) << t;
      EXPECT_NEAR(table.temperature(l), t, 1e-6) << t;
    }
  }
  EXPECT_EQ(BandTable(lower, upper).radiance(0), 0);
}

}  // namespace
}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// spectral_response and window_spectrum: the signal at the reference temperature is the Planck
// integral under both, reckoned here anew by Simpson's rule.
#include <cmath>
#include <functional>

#include "imaging/programs/program_test.hpp"

namespace meltproof::imaging {
namespace {

/// W m-2 sr-1 of a black body from `from` to `to`, m, under a weight.
double radiance(double temperature, double from, double to,
                const std::function<double(double)>& weight) {
  constexpr double h = 6.62607015e-34, c = 299792458, k = 1.380649e-23;
  constexpr int steps = 2000;
  double sum = 0;
  for (int i = 0; i <= steps; ++i) {
    const double l = from + (to - from) * i / steps;
    const double planck =
        2 * h * c * c / (std::pow(l, 5) * std::expm1(h * c / (l * k * temperature)));
    sum += (i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2) * planck * weight(l);
  }
  return sum * (to - from) / steps / 3;
}

// The level alone is asked for.
const std::string quick = "reference_signal = 'off'\n[budget]\ndraws = 100\n";

class Spectra : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    const auto film = file("film.toml", "[rosenthal]\nview = 'top'\nframes = 52\n");
    ASSERT_EQ(run(fmt::format("{} --rosenthal --settings {} --output {}", CAMERA, film.string(),
                              recording())),
              0)
        << text_;
    file("response.csv", "wavelength [um],response [1]\n3,0.2\n4,1\n5,0.6\n");
    file("window.csv", "wavelength [nm],transmission [%]\n2000,10\n6000,50\n");
  }
  std::string recording() const { return (folder_ / "track.h5").string(); }
  std::string command(const std::string& settings) {
    return fmt::format(
        "{} {} --output {} --settings {} --reference-temperature '1683 K' --emissivity 0.3 "
        "--emissivity-liquid 0.3",
        THERMOGRAPHY, recording(), output().string(), file("s.toml", settings + quick).string());
  }
  /// Counts above dark at the reference temperature.
  double signal(const std::string& settings) {
    EXPECT_EQ(run(command(settings)), 0) << text_;
    const auto summary = json_of(output() / "summary.json");
    for (const auto& p : summary["parameters"]) {
      if (p["name"] == "gain") gain_ = p["value"].get<double>();
      if (p["name"] == "signal without light") dark_ = p["value"].get<double>();
      if (p["name"] == "integration time") time_ = p["value"].get<double>();
    }
    return summary["level"]["value"].get<double>() - dark_;
  }
  double expected(double from, double to, const std::function<double(double)>& weight) const {
    constexpr double emissivity = 0.3, surroundings = 293.15;
    return gain_ * time_ *
           (emissivity * radiance(1683, from, to, weight) +
            (1 - emissivity) * radiance(surroundings, from, to, weight));
  }
  double gain_ = 0, dark_ = 0, time_ = 0;
};

TEST_F(Spectra, TheSignalIsThePlanckIntegralUnderDetectorAndWindow) {
  const double flat = signal("transmission = 0.313\n");
  EXPECT_NEAR(flat / expected(3e-6, 5e-6, [](double) { return 0.313; }), 1, 1e-4);
  const auto response = [](double l) {
    const double um = l * 1e6;
    return um < 4 ? 0.2 + 0.8 * (um - 3) : 1 - 0.4 * (um - 4);
  };
  // Without a window's table the transmission of the settings holds.
  const double detector = signal("spectral_response = 'response.csv'\ntransmission = 0.313\n");
  EXPECT_NEAR(detector / expected(3e-6, 5e-6, [&](double l) { return 0.313 * response(l); }), 1,
              1e-3);
  const double windows =
      signal("spectral_response = 'response.csv'\nwindow_spectrum = 'window.csv'\n");
  const auto both = [&](double l) { return response(l) * (0.1 + 0.1 * (l * 1e6 - 2)); };
  EXPECT_NEAR(windows / expected(3e-6, 5e-6, both), 1, 1e-3);
}

TEST_F(Spectra, AWindowThatShutsPartOfTheBandTakesItsPartOfTheSignal) {
  file("response.csv", "wavelength [um],response [1]\n3,1\n5,1\n");
  file("window.csv", "wavelength [um],transmission [1]\n4.2,1\n5,1\n");
  const double part =
      signal("spectral_response = 'response.csv'\nwindow_spectrum = 'window.csv'\n");
  EXPECT_NEAR(part / expected(4.2e-6, 5e-6, [](double) { return 1.0; }), 1, 1e-3);
}

TEST_F(Spectra, WhatIsWrongWithATableIsSaidInASentence) {
  const std::string response = "spectral_response = 'response.csv'\n";
  expect_refusal(command("window_spectrum = 'window.csv'\n"), "spectral_response");
  expect_refusal(command(response + "window_spectrum = 'window.csv'\ntransmission = 0.3\n"),
                 "give one of them");
  expect_refusal(command("spectral_response = 'gone.csv'\n"), "gone.csv");
  for (const auto& [table, said] :
       {std::pair{"wavelength,response [1]\n3,1\n5,1\n", "names no unit"},
        std::pair{"wavelength [um],response [1]\n3,one\n5,1\n", "line 2: \"one\" is no number"},
        std::pair{"wavelength [um],response [1]\n5,1\n3,1\n", "must be positive and increase"},
        std::pair{"wavelength [um],response [1]\n3,1\n", "two points or more"},
        std::pair{"wavelength [um],response [1]\n3,0\n5,0\n", "all values are zero"},
        std::pair{"wavelength [um];response [1]\n3;1\n", "two columns separated by a comma"},
        std::pair{"wavelength [um],response [1]\n3,-1\n5,1\n", "zero or more"}}) {
    file("response.csv", table);
    expect_refusal(command(response), said);
  }
  file("response.csv", "wavelength [um],response [1]\n3,1\n5,1\n");
  file("window.csv", "wavelength [um],transmission [1]\n8,1\n12,1\n");
  expect_refusal(command(response + "window_spectrum = 'window.csv'\n"), "in common");
}

}  // namespace
}  // namespace meltproof::imaging

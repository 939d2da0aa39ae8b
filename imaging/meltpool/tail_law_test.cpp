// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/tail_law.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "imaging/radiometry/radiometry.hpp"

namespace meltproof::imaging {
namespace {

constexpr double star = 7.5;

TEST(TailLaw, LeavesLiquidMetalAsItIs) {
  const TailLaw law{.log_signal = star, .ratio = 0.4, .interval = 0.6};
  for (const double above : {0.05, 0.4, 1.5})
    EXPECT_DOUBLE_EQ(tail_law(law, star + above, 0.02).log_signal, star + above);
}

TEST(TailLaw, StepsAbruptlyWhereNoHeatIsReleased) {
  const TailLaw law{.log_signal = star, .ratio = std::log(1.5)};
  EXPECT_NEAR(tail_law(law, star - 0.1, 0.02).log_signal, star - 0.1 + std::log(1.5), 1e-12);
  // In a cell that the front halves, half of the radiance is that of solid metal.
  EXPECT_NEAR(tail_law(law, star, 0.02).log_signal, star + std::log(1.25), 1e-3);
}

// Energy: while the metal freezes it gives back what it released, so that far behind the front its
// temperature by Planck's law is higher by L than that of liquid metal of the same enthalpy.
TEST(TailLaw, ReturnsTheHeatThatIsReleased) {
  const TailLaw law{.log_signal = star, .interval = 0.6};
  const double theta = star - 1.4;
  const double x = law.steepness.x();
  const auto tau = [&](double log_signal) {
    return x / std::log(1 + (std::exp(x) - 1) * std::exp(star - log_signal));
  };
  const double released = (1 - TailLaw::sensible) * law.interval / law.steepness;
  EXPECT_NEAR(tau(tail_law(law, theta, 0.02).log_signal) - tau(theta), released, 1e-12);
  EXPECT_NEAR(law.rise(), 0.88 * 0.6, 1e-12);
}

// Of Planck's law, and of its limits: Wien's at short waves, Rayleigh's and Jeans's at long ones.
TEST(TailLaw, KnowsTheWavelengthOfItsSteepness) {
  for (const double b : {1.05, 1.5, 2.5, 9.6}) {
    const Steepness s = b;
    EXPECT_DOUBLE_EQ(s, b);
    EXPECT_NEAR(s.x() / (1 - std::exp(-s.x())), b, 1e-12);
  }
  EXPECT_NEAR(Steepness(20).x(), 20, 1e-6);
  EXPECT_NEAR(Steepness(0.5).x(), 0.04, 1e-3);
}

// Heat that is given off lifts frozen metal to where the band's own radiance has it, to 0.01;
// Wien's form of the law would be 0.045 off at 1350 K.
TEST(TailLaw, FollowsTheRadianceOfACameraSBand) {
  const Radiometry band;  // 3 to 5 um
  constexpr double liquidus = 1683;
  const auto log_signal = [&](double t) { return std::log(signal(band, t) - band.dark); };
  const double b = liquidus * (log_signal(liquidus + 1) - log_signal(liquidus - 1)) / 2;
  const TailLaw law{.log_signal = log_signal(liquidus), .interval = 0.25 * b, .steepness = b};
  const double released = (1 - TailLaw::sensible) * 0.25 * liquidus;
  for (const double t : {1350.0, 1450.0, 1550.0})
    EXPECT_NEAR(tail_law(law, log_signal(t - released), 1e-6).log_signal, log_signal(t), 0.015)
        << t;
}

// Ahead of the beam the field falls without end.
TEST(TailLaw, StaysFiniteHoweverColdTheMetalIs) {
  const TailLaw law{.log_signal = star, .ratio = 0.1, .interval = 0.6};
  for (const double below : {10.0, 300.0, 1e4, 1e9}) {
    const TailLawValue v = tail_law(law, star - below, 2);
    for (const double number :
         {v.log_signal, v.by_theta, v.by_theta_star, v.by_ratio, v.by_interval})
      EXPECT_TRUE(std::isfinite(number)) << below;
    EXPECT_LT(v.log_signal, star - 2) << below;
  }
}

TEST(TailLaw, HasTheDerivativesOfItsValue) {
  // That the cell's own width changes with theta is left out of the derivatives: a hundredth of it.
  constexpr double d = 1e-6, cell = 0.01;
  const auto value = [&](TailLaw law, double theta) {
    return tail_law(law, theta, cell).log_signal;
  };
  for (const TailLaw& law :
       {TailLaw{.log_signal = star, .ratio = 0.4, .interval = 0.55},
        TailLaw{.log_signal = star, .interval = 0.7}, TailLaw{.log_signal = star, .ratio = 0.4}}) {
    for (const double below : {0.005, 0.1, 0.31, 0.9}) {
      const double theta = star - below;
      const TailLawValue v = tail_law(law, theta, cell);
      const auto moved = [&](double TailLaw::*of) {
        TailLaw up = law, down = law;
        up.*of += d;
        down.*of -= d;
        return (value(up, theta) - value(down, theta)) / (2 * d);
      };
      EXPECT_NEAR(v.by_theta, (value(law, theta + d) - value(law, theta - d)) / (2 * d), 2e-3);
      EXPECT_NEAR(v.by_theta_star, moved(&TailLaw::log_signal), 2e-3);
      EXPECT_NEAR(v.by_ratio, moved(&TailLaw::ratio), 1e-5);
      if (law.interval > 0) {
        EXPECT_NEAR(v.by_interval, moved(&TailLaw::interval), 1e-5);
      }
    }
  }
}

}  // namespace
}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/linescan/registration.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace meltproof::validation {
namespace {

struct Curve {
  std::vector<double> x, y;
};

/// A synthetic falling profile from 0 to 20 um, displaced by `shift`, on `n` points.
Curve erfc_profile(double shift, int n, double from = 0, double to = 20e-6) {
  Curve c;
  for (int i = 0; i < n; ++i) {
    const double x = from + (to - from) * i / (n - 1);
    c.x.push_back(x);
    c.y.push_back(0.5 * std::erfc((x + shift - 8e-6) / 3e-6));
  }
  return c;
}

TEST(Registration, FindsAKnownShift) {
  const auto s = erfc_profile(0, 401), d = erfc_profile(1.3e-6, 15, 4e-6, 16e-6);
  const auto r = register_profiles(s.x, s.y, d.x, d.y, {}, {}, {.shift = 3e-6});
  EXPECT_NEAR(r.shift, 1.3e-6, 1e-8);
  EXPECT_LT(r.after.root_mean_square, 1e-4);
  EXPECT_GT(r.before.root_mean_square, 0.05);
  EXPECT_EQ(r.before.points, r.after.points);
  EXPECT_EQ(r.fitted, 1u);
}

TEST(Registration, StaysWithinItsBound) {
  const auto s = erfc_profile(0, 401), d = erfc_profile(1.3e-6, 15, 4e-6, 16e-6);
  const auto r = register_profiles(s.x, s.y, d.x, d.y, {}, {}, {.shift = 0.5e-6});
  EXPECT_NEAR(r.shift, 0.5e-6, 1e-9);
  const auto none = register_profiles(s.x, s.y, d.x, d.y, {}, {}, {});
  EXPECT_EQ(none.shift, 0);
  EXPECT_EQ(none.fitted, 0u);
  EXPECT_EQ(none.after.root_mean_square, none.before.root_mean_square);
}

TEST(Registration, NeverFitsTheVerticalScale) {
  const auto s = erfc_profile(0, 401);
  auto d = erfc_profile(0, 15, 4e-6, 16e-6);
  for (double& value : d.y) {
    value *= 0.5;
  }
  const auto r = register_profiles(s.x, s.y, d.x, d.y, {}, {}, {.shift = 1e-6});
  EXPECT_GT(r.after.root_mean_square, 0.1);
}

TEST(Registration, TurnsALineOnlyIfAllowed) {
  const auto s = erfc_profile(0, 401);
  auto d = erfc_profile(0, 15, 4e-6, 16e-6);
  for (double& x : d.x) {
    x = 20e-6 - x;
  }
  EXPECT_GT(register_profiles(s.x, s.y, d.x, d.y, {}, {}, {}).after.root_mean_square, 0.3);
  const auto r = register_profiles(s.x, s.y, d.x, d.y, {}, {}, {.shift = 0, .reversible = true});
  EXPECT_TRUE(r.reversed);
  EXPECT_LT(r.after.root_mean_square, 1e-4);
  EXPECT_EQ(r.fitted, 1u);
}

TEST(Registration, MayFollowALandmark) {
  const auto s = erfc_profile(0, 401), d = erfc_profile(1.3e-6, 15, 4e-6, 16e-6);
  RegistrationBounds bounds{.shift = 3e-6, .landmark = Landmark{}};
  const auto half = register_profiles(s.x, s.y, d.x, d.y, {}, {}, bounds);
  EXPECT_TRUE(half.by_landmark);
  EXPECT_NEAR(half.shift, 1.3e-6, 0.05e-6);  // between points 0.86 um apart
  EXPECT_EQ(half.fitted, 1u);
  bounds.landmark = Landmark{false, 8e-6, 6.7e-6};
  const auto named = register_profiles(s.x, s.y, d.x, d.y, {}, {}, bounds);
  EXPECT_NEAR(named.shift, 1.3e-6, 1e-15);
  EXPECT_LT(named.after.root_mean_square, 1e-4);
  bounds.landmark = Landmark{false, 9e-6, 5e-6};
  EXPECT_THROW(register_profiles(s.x, s.y, d.x, d.y, {}, {}, bounds), InputError);
  const std::vector<double> flat(15, 0.5);
  bounds.landmark = Landmark{};
  EXPECT_THROW(register_profiles(s.x, s.y, d.x, flat, {}, {}, bounds), InputError);
}

TEST(Registration, SaysWhereTheSimulatedLineIsRead) {
  const auto s = erfc_profile(0, 401);
  auto d = erfc_profile(0, 15, 4e-6, 16e-6);
  for (double& x : d.x) {
    x = 20e-6 - x;
  }
  const auto r = register_profiles(s.x, s.y, d.x, d.y, {}, {}, {.shift = 0, .reversible = true});
  EXPECT_NEAR(r.place[0], 4e-6, 1e-12);
  EXPECT_EQ(r.index[14], 14u);
  EXPECT_GT(std::abs(r.simulated_before[0] - r.measured[0]), 0.3);
}

TEST(Registration, ComparesTheSamePointsForEveryShift) {
  auto s = erfc_profile(0, 401);
  const auto d = erfc_profile(0, 21);  // 0 to 20 um, every 1 um
  EXPECT_EQ(register_profiles(s.x, s.y, d.x, d.y, {}, {}, {}).after.points, 21u);
  EXPECT_EQ(register_profiles(s.x, s.y, d.x, d.y, {}, {}, {.shift = 2e-6}).after.points, 17u);
  s.y[200] = std::numeric_limits<double>::quiet_NaN();  // no material at 10 um
  EXPECT_EQ(register_profiles(s.x, s.y, d.x, d.y, {}, {}, {.shift = 2e-6}).after.points, 12u);
  const std::vector<std::size_t> flagged = {3, 4};
  EXPECT_EQ(register_profiles(s.x, s.y, d.x, d.y, {}, flagged, {.shift = 2e-6}).after.points, 10u);
  EXPECT_THROW(register_profiles(s.x, s.y, d.x, d.y, {}, {}, {.shift = 9.5e-6}), InputError);
}

}  // namespace
}  // namespace meltproof::validation

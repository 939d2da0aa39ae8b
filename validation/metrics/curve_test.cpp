// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/metrics/curve.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace meltproof::validation {
namespace {

TEST(CurveMetrics, OfHandComputedDifferences) {
  const std::vector<double> measured = {0, 1, 2, 3}, simulated = {1, 1, 2, 1}, u = {1, 1, 1, 2};
  const auto result = curve_metrics(simulated, measured, u, 1);
  EXPECT_DOUBLE_EQ(result.bias, -0.25);
  EXPECT_DOUBLE_EQ(result.mean_absolute, 0.75);
  EXPECT_DOUBLE_EQ(result.root_mean_square, std::sqrt(5.0 / 4));
  EXPECT_DOUBLE_EQ(result.maximum_deviation, 2);
  EXPECT_DOUBLE_EQ(*result.r_squared, 1 - 5.0 / 5.0);
  EXPECT_DOUBLE_EQ(*result.reduced_chi_square, 2.0 / 3);  // (1 + 1) over 4 points - 1 fitted
}

TEST(CurveMetrics, OfEqualCurvesAreZero) {
  const std::vector<double> curve = {1, 2, 4};
  const auto result = curve_metrics(curve, curve);
  EXPECT_EQ(result.root_mean_square, 0);
  EXPECT_EQ(*result.r_squared, 1);
  EXPECT_FALSE(result.reduced_chi_square);
}

TEST(CurveMetrics, RefuseWhatCannotBeCompared) {
  const std::vector<double> two = {1, 2}, three = {1, 2, 3}, none;
  EXPECT_THROW(curve_metrics(two, three), InputError);
  EXPECT_THROW(curve_metrics(none, none), InputError);
  EXPECT_THROW(curve_metrics(two, two, std::vector<double>{1, 0}), InputError);
  EXPECT_FALSE(curve_metrics(two, std::vector<double>{1, 1}).r_squared);
}

}  // namespace
}  // namespace meltproof::validation

// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/metrics/grid_convergence.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace meltproof::validation {
namespace {

// The worked example of NASA's tutorial on grid convergence.
TEST(GridConvergence, PublishedExample) {
  const auto result = grid_convergence({0.9705, 0.96854, 0.96178}, 2);
  // The published order stems from unrounded values; the five digits above give 1.786170.
  EXPECT_NEAR(result.order, 1.78618, 2e-5);
  EXPECT_NEAR(result.order, std::log(0.00676 / 0.00196) / std::log(2.0), 1e-10);
  EXPECT_NEAR(result.extrapolated, 0.97130, 5e-6);
  EXPECT_NEAR(100 * result.index_fine, 0.10308, 5e-6);
  EXPECT_NEAR(100 * result.index_coarse, 0.35625, 5e-6);
  EXPECT_NEAR(result.asymptotic, 1, 0.01);
}

TEST(GridConvergence, IsExactForAPowerOfTheSpacing) {
  const auto f = [](double h) { return 3 - 0.2 * h * h; };
  const auto result = grid_convergence({f(1), f(1.5), f(2.25)}, 1.5);
  EXPECT_NEAR(result.order, 2, 1e-12);
  EXPECT_NEAR(result.extrapolated, 3, 1e-12);
  EXPECT_NEAR(result.index_fine * f(1), 1.25 * 0.2, 1e-12);
}

std::string refusal(const std::array<double, 3>& values) {
  try {
    grid_convergence(values, 2);
  } catch (const InputError& problem) {
    return problem.what();
  }
  return "";
}

TEST(GridConvergence, RefusesASeriesWithoutAnOrder) {
  EXPECT_NE(refusal({1.0, 1.1, 1.05}).find("oscillates"), std::string::npos);
  EXPECT_NE(refusal({1.0, 1.2, 1.3}).find("moves apart"), std::string::npos);
  EXPECT_NE(refusal({1.0, 1.0, 1.3}).find("does not change"), std::string::npos);
  EXPECT_THROW(grid_convergence({0.9705, 0.96854, 0.96178}, 1), InputError);
}

TEST(GridConvergence, UnequalRatiosGiveTheOrderOfAPowerOfTheSpacing) {
  const auto f = [](double h) { return 3 - 0.2 * std::pow(h, 1.3); };
  const auto result = resolution_series({7, 10, 14}, {f(7), f(10), f(14)});
  EXPECT_EQ(result.behaviour, "converges");
  EXPECT_NEAR(result.order, 1.3, 1e-9);
  EXPECT_NEAR(result.extrapolated, 3, 1e-9);
  EXPECT_NEAR(result.uncertainty[1], 0.5 * 1.25 * (3 - f(10)), 1e-9);
}

TEST(GridConvergence, EqualRatiosGiveTheIndexOfThePublishedExample) {
  const auto result = resolution_series({1, 2, 4}, {0.9705, 0.96854, 0.96178});
  EXPECT_NEAR(result.order, 1.78618, 2e-5);
  EXPECT_NEAR(100 * 2 * result.uncertainty[0] / 0.9705, 0.10308, 5e-6);
  EXPECT_NEAR(100 * 2 * result.uncertainty[1] / 0.96854, 0.35625, 5e-6);
}

TEST(GridConvergence, ASeriesWithoutAnOrderStillHasAnUncertainty) {
  const auto oscillating = resolution_series({7, 10, 14}, {300, 310, 302});
  EXPECT_EQ(oscillating.behaviour, "oscillates");
  EXPECT_NEAR(oscillating.uncertainty[0], 0.5 * 5, 1e-12);
  const auto unsettled = resolution_series({7, 10, 14}, {300, 310, 315});
  EXPECT_EQ(unsettled.behaviour, "unsettled");
  EXPECT_NEAR(unsettled.uncertainty[0], 0.5 * 45, 1e-12);
  // Faster than the scheme can be: noise, so the formal order counts.
  const auto noisy = resolution_series({7, 10, 14}, {300, 301, 320});
  EXPECT_GT(noisy.order, 4);
  EXPECT_NEAR(noisy.extrapolated, 300 - 1 / (100.0 / 49 - 1), 1e-9);
  EXPECT_THROW(resolution_series({10, 7, 14}, {1, 2, 3}), InputError);
}

TEST(GridConvergence, TwoGridsTakeThreeTimesTheDifference) {
  EXPECT_NEAR(two_grid_index(1.0, 0.97, 2, 2), 3 * 0.03 / 3, 1e-12);
}

TEST(GridConvergence, FitFindsTheOrderThroughNoise) {
  const std::vector<double> spacings = {1, 2, 3, 4, 6};
  std::vector<double> values;
  const std::vector<double> noise = {1e-4, -1e-4, 1e-4, -1e-4, 0};
  for (std::size_t i = 0; i < spacings.size(); ++i) {
    values.push_back(5 + 0.03 * std::pow(spacings[i], 1.5) + noise[i]);
  }
  const auto result = fit_convergence(spacings, values);
  EXPECT_NEAR(result.order, 1.5, 0.02);
  EXPECT_NEAR(result.extrapolated, 5, 1e-3);
  EXPECT_NEAR(result.amplitude, 0.03, 1e-3);
  EXPECT_LT(result.scatter, 3e-4);
  EXPECT_THROW(fit_convergence(std::vector<double>{1, 2, 3}, std::vector<double>{1, 2, 3}),
               InputError);
  // Values that do not approach anything: an error growing ever faster than the fourth power.
  EXPECT_THROW(fit_convergence(std::vector<double>{1, 2, 4, 8}, std::vector<double>{0, 0, 0, 1}),
               InputError);
}

}  // namespace
}  // namespace meltproof::validation

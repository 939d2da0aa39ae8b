// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/metrics/trend.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace meltproof::validation {
namespace {

TrendResult of(const std::vector<double>& values, const std::vector<double>& u, double k = 2) {
  return trend(values, u, k).result;
}

TEST(Trend, RisesOnlyBeyondItsUncertainty) {
  EXPECT_EQ(of({300, 310, 330}, {3, 3, 3}), TrendResult::rises);  // 10 > 2 sqrt(18) = 8.5
  EXPECT_EQ(of({300, 308, 330}, {3, 3, 3}), TrendResult::undecided);
  EXPECT_EQ(of({300, 310, 330}, {}), TrendResult::rises);
  EXPECT_EQ(of({300, 300, 330}, {}), TrendResult::undecided);
}

TEST(Trend, FallsIfOneStepFallsBeyondIt) {
  EXPECT_EQ(of({300, 310, 290}, {3, 3, 3}), TrendResult::falls);
  EXPECT_EQ(of({300, 310, 306}, {3, 3, 3}), TrendResult::undecided);
}

TEST(Trend, GivesTheProbabilityOfEachStep) {
  const auto result = trend(std::vector<double>{0, 5, 4}, std::vector<double>{3, 4, 3}, 2);
  EXPECT_NEAR(result.steps[0].confidence, 0.841345, 1e-6);      // one sigma
  EXPECT_NEAR(result.steps[1].confidence, 1 - 0.579260, 1e-6);  // minus a fifth of a sigma
  EXPECT_EQ(result.weakest, 1u);
  EXPECT_THROW(trend(std::vector<double>{1}, {}, 2), InputError);
}

}  // namespace
}  // namespace meltproof::validation

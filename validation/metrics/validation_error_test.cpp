// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/metrics/validation_error.hpp"

#include <gtest/gtest.h>

namespace meltproof::validation {
namespace {

TEST(ValidationError, AddsTheThreeUncertaintiesInQuadrature) {
  const auto result = validation_error(310, 300, {.numerical = 2, .input = 3, .data = 6}, 2);
  EXPECT_DOUBLE_EQ(result.error, 10);
  EXPECT_DOUBLE_EQ(result.uncertainty, 7);
  EXPECT_DOUBLE_EQ(result.lower, -4);
  EXPECT_DOUBLE_EQ(result.upper, 24);
  EXPECT_TRUE(result.within());
  EXPECT_TRUE(result.complete);
}

TEST(ValidationError, IsSeenWhenItExceedsTheNoise) {
  EXPECT_FALSE(validation_error(310, 300, {.numerical = 2, .input = 3, .data = 6}, 1).within());
  EXPECT_FALSE(validation_error(290, 300, {.numerical = 2, .input = 3, .data = 6}, 1).within());
}

TEST(ValidationError, SaysThatItsUncertaintyIsALowerBound) {
  const auto result =
      validation_error(1, 2, {.numerical = std::nullopt, .input = std::nullopt, .data = 0.5}, 1);
  EXPECT_FALSE(result.complete);
  EXPECT_DOUBLE_EQ(result.uncertainty, 0.5);
}

}  // namespace
}  // namespace meltproof::validation

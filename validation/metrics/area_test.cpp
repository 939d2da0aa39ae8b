// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/metrics/area.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace meltproof::validation {
namespace {

TEST(AreaMetric, OfTwoNumbersIsTheirDistance) {
  EXPECT_DOUBLE_EQ(area_metric({3}, {5}), 2);
  EXPECT_DOUBLE_EQ(area_metric({5}, {3}), 2);
}

TEST(AreaMetric, OfAShiftedSampleIsTheShift) {
  EXPECT_NEAR(area_metric({1, 2, 4, 7}, {3, 4, 6, 9}), 2, 1e-12);
}

TEST(AreaMetric, OfASampleAgainstANumberIsTheMeanDistance) {
  EXPECT_NEAR(area_metric({1, 2, 6}, {2}), (1 + 0 + 4) / 3.0, 1e-12);
}

TEST(AreaMetric, IsZeroForEqualDistributionsOfOtherSize) {
  EXPECT_NEAR(area_metric({1, 2}, {1, 1, 2, 2}), 0, 1e-12);
  EXPECT_THROW(area_metric({}, {1}), InputError);
}

}  // namespace
}  // namespace meltproof::validation

// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/radiometry/uniformity.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace meltproof::imaging {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// A made-up sensor whose pixels have their own offsets and gains: a uniform scene becomes uniform.
TEST(Uniformity, TakesOffAndGainOfEveryPixelBack) {
  const std::vector<double> offset = {200, 230, 180, 205, 190}, gain = {1, 1.05, 0.93, 1.02, 1};
  const auto seen = [&](double light) {
    std::vector<double> v;
    for (std::size_t i = 0; i < gain.size(); ++i) v.push_back(offset[i] + gain[i] * light);
    return v;
  };
  const Uniformity u = two_point(seen(1000), seen(4000));
  EXPECT_EQ(u.dead, 0u);
  const auto raw = seen(2500);
  std::vector<float> values(raw.begin(), raw.end());
  correct(u, values, infinity, -infinity);
  for (const float v : values) EXPECT_NEAR(v, values[0], 1e-3);
  // The mean of the offsets and of the gains, which the correction keeps: 201 + 2500.
  EXPECT_NEAR(values[0], 201 + 2500, 1);
}

TEST(Uniformity, FindsDeadPixelsAndKeepsTheMarks) {
  const std::vector<double> cold = {100, 100, 100, 100, 100}, hot = {200, 100, 600, 210, 190};
  const Uniformity u = two_point(cold, hot);
  EXPECT_EQ(u.dead, 2u);
  std::vector<float> values = {16383, 150, 150, 16383, 16382};
  correct(u, values, 16383, 0);
  EXPECT_GE(values[0], 16383);
  EXPECT_TRUE(std::isnan(values[1]));
  EXPECT_TRUE(std::isnan(values[2]));
  EXPECT_GE(values[3], 16383);  // its gain is below one: corrected it would seem good
  EXPECT_LT(values[4], 16383);  // its gain is above one: corrected it would seem saturated
}

TEST(Uniformity, RefusesReferencesThatDoNotFit) {
  EXPECT_THROW(two_point({1, 2}, {3}), InputError);
  EXPECT_THROW(two_point({10, 10}, {5, 5}), InputError);
  std::vector<float> other = {1, 2, 3};
  EXPECT_THROW(correct(two_point({1, 1}, {5, 5}), other, infinity, -infinity), InputError);
}

}  // namespace
}  // namespace meltproof::imaging

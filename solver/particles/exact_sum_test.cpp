// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/particles/exact_sum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace meltproof::solver {
namespace {

double sum_of(const std::vector<double>& values) {
  return exact_sum(values.size(), [&](std::size_t i) { return values[i]; }).total();
}

}  // namespace

TEST(ExactSum, IsExactWhereDoublesAreNot) {
  EXPECT_EQ(sum_of({}), 0);
  EXPECT_EQ(sum_of({1e300, 1, -1e300}), 1);
  EXPECT_EQ(sum_of({1, 1e100, 1, -1e100}), 2);
  EXPECT_EQ(sum_of({-3.5, 1.25}), -2.25);
  EXPECT_EQ(sum_of({0.1, -0.1}), 0);
  EXPECT_EQ(sum_of({-1e-300, 1e-320, 1e-300}), 1e-320);
  for (const double one : {1.0, -0.3, 1e-310, std::numeric_limits<double>::max(),
                           -std::numeric_limits<double>::denorm_min(), 6.02e23}) {
    EXPECT_EQ(sum_of({one}), one);
  }
}

TEST(ExactSum, DoesNotDependOnOrderOrParts) {
  std::mt19937_64 random(3);
  std::vector<double> values;
  for (int i = 0; i < 5000; ++i) {
    const double mantissa = static_cast<double>(random() >> 11U) * 0x1p-53 - 0.5;
    values.push_back(std::ldexp(mantissa, static_cast<int>(random() % 120) - 60));
  }
  const double whole = sum_of(values);
  double plain = 0;
  for (const double v : values) {
    plain += v;
  }
  EXPECT_NEAR(whole / plain, 1, 1e-10);
  bool plain_differs = false;
  for (int round = 0; round < 20; ++round) {
    std::shuffle(values.begin(), values.end(), random);
    double again = 0;
    ExactSum parts[3], joined;
    for (std::size_t i = 0; i < values.size(); ++i) {
      again += values[i];
      parts[random() % 3].add(values[i]);
    }
    plain_differs = plain_differs || again != plain;
    for (const ExactSum& part : parts) {
      joined.add(part);
    }
    EXPECT_EQ(sum_of(values), whole);
    EXPECT_EQ(joined.total(), whole);
  }
  EXPECT_TRUE(plain_differs) << "these values would not tell an exact sum from a plain one";
}

TEST(ExactSum, WhatIsNoNumberShows) {
  EXPECT_TRUE(std::isnan(sum_of({1, std::numeric_limits<double>::quiet_NaN()})));
  EXPECT_TRUE(std::isnan(sum_of({std::numeric_limits<double>::infinity(), 2})));
}

}  // namespace meltproof::solver

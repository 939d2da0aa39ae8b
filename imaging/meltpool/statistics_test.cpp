// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/statistics.hpp"

#include <cmath>
#include <map>
#include <random>

#include <gtest/gtest.h>

namespace meltproof::imaging {
namespace {

/// Mann and Kendall's statistic pair by pair, as they define it: S is the number of rising pairs
/// less that of falling ones, its variance n (n - 1) (2 n + 5) / 18 less the same of every tie.
double pair_by_pair(const std::vector<double>& v) {
  double s = 0;
  std::map<double, double> ties;
  for (std::size_t i = 0; i < v.size(); ++i) {
    ties[v[i]] += 1;
    for (std::size_t j = i + 1; j < v.size(); ++j) s += v[j] > v[i] ? 1 : v[j] < v[i] ? -1 : 0;
  }
  const auto term = [](double n) { return n * (n - 1) * (2 * n + 5) / 18; };
  double variance = term(static_cast<double>(v.size()));
  for (const auto& [value, count] : ties) variance -= term(count);
  if (!(variance > 0) || s == 0) return 0;
  return (s > 0 ? s - 1 : s + 1) / std::sqrt(variance);
}

// Ten values that only rise: S = 45, var S = 125, Z = 44 / sqrt(125).
TEST(Trend, IsThatOfMannAndKendall) {
  std::vector<double> rising, falling;
  for (int i = 0; i < 10; ++i) rising.push_back(i * i), falling.push_back(-i);
  EXPECT_NEAR(summarise(rising).trend, 44 / std::sqrt(125.0), 1e-12);
  EXPECT_NEAR(summarise(falling).trend, -44 / std::sqrt(125.0), 1e-12);
  EXPECT_FALSE(summarise(rising).steady());
  EXPECT_EQ(summarise(std::vector<double>(12, 3.5)).trend, 0);
  EXPECT_EQ(summarise(std::vector<double>{1, 2, 3}).trend, 0) << "too few to tell";
}

TEST(Trend, IsCountedAsPairByPair) {
  std::mt19937_64 random(31);
  for (std::size_t n = 4; n < 160; ++n)
    for (const int kinds : {2, 7, 1000000}) {  // many ties, some, hardly any
      std::vector<double> v;
      for (std::size_t i = 0; i < n; ++i)
        v.push_back(static_cast<double>(random() % static_cast<unsigned>(kinds)) +
                    0.01 * kinds * static_cast<double>(i % (n / 2 + 1)) / static_cast<double>(n));
      ASSERT_NEAR(summarise(v).trend, pair_by_pair(v), 1e-9) << n << " values of " << kinds;
    }
}

// The test is one at 5 %: so often a series without a trend is called unsteady.
TEST(Trend, IsSeenInOneSeriesOfTwentyWithoutOne) {
  std::mt19937_64 random(32);
  int unsteady = 0;
  for (int k = 0; k < 2000; ++k) {
    std::vector<double> v;
    for (int i = 0; i < 40; ++i) v.push_back(static_cast<double>(random() >> 11));
    unsteady += summarise(v).steady() ? 0 : 1;
  }
  EXPECT_NEAR(unsteady / 2000.0, 0.05, 0.015);
}

}  // namespace
}  // namespace meltproof::imaging

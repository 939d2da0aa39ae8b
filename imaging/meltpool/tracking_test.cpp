// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/tracking.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "imaging/meltpool/campaign.hpp"
#include "imaging/meltpool/statistics.hpp"

namespace meltproof::imaging {
namespace {

/// A pool that enters at the left, and leaves at the right border of 96 px.
std::vector<Sighting> passage(std::size_t first, std::size_t frames = 44) {
  std::vector<Sighting> seen;
  for (std::size_t i = 0; i < frames; ++i) {
    const double onset = 2.1825 * static_cast<double>(i);
    seen.push_back({first + i, onset > 16 && onset < 95, std::min(onset, 95.5), 20, 60});
  }
  return seen;
}

TEST(Passages, HaveTheSpeedOfTheirPool) {
  auto seen = passage(0);
  seen[25].onset += 20;  // spatter, taken for the pool
  const auto passages = find_passages(seen, 96);
  ASSERT_EQ(passages.size(), 1u);
  EXPECT_NEAR(passages[0].speed, 2.1825, 1e-9);
  EXPECT_EQ(disturbance_of(seen[25], passages[0]), Disturbance::displaced);
  EXPECT_EQ(disturbance_of(seen[24], passages[0]), Disturbance::none);
  Sighting merged = seen[24];
  merged.area = 90;
  EXPECT_EQ(disturbance_of(merged, passages[0]), Disturbance::enlarged);
  Sighting aside = seen[24];
  aside.across = 27;
  EXPECT_EQ(disturbance_of(aside, passages[0]), Disturbance::displaced);
}

TEST(Passages, BeginAnewWhenThePoolDoes) {
  auto seen = passage(0);
  for (const auto& s : passage(44)) seen.push_back(s);
  for (const auto& s : passage(200)) seen.push_back(s);
  EXPECT_EQ(find_passages(seen, 96).size(), 3u);
  EXPECT_TRUE(find_passages(std::vector<Sighting>(seen.begin(), seen.begin() + 5), 96).empty());
}

TEST(RobustLine, IsNotMovedByAQuarterOfOutliers) {
  std::vector<double> x, y;
  for (int i = 0; i < 20; ++i) {
    x.push_back(i);
    y.push_back(i % 5 == 0 ? 100 : 3 + 0.5 * i);
  }
  const RobustLine line = robust_line(x, y);
  EXPECT_NEAR(line.slope, 0.5, 1e-12);
  EXPECT_NEAR(line.intercept, 3, 1e-12);
}

// Three tracks of equal means: all spread is between frames. The same with means 10 apart.
TEST(Campaign, PartsTheSpread) {
  const auto same = campaign_statistics({{300, 6, 40, 36}, {300, 6, 40, 36}, {300, 6, 40, 36}});
  EXPECT_NEAR(same.between_frames, 6, 1e-12);
  EXPECT_EQ(same.between_tracks, 0);
  const auto apart = campaign_statistics({{290, 6, 40, 36}, {300, 6, 40, 36}, {310, 6, 40, 36}});
  EXPECT_NEAR(apart.mean, 300, 1e-9);
  EXPECT_NEAR(apart.between_tracks, std::sqrt(100.0 - 1), 1e-9);
  EXPECT_NEAR(apart.u_mean, 10 / std::sqrt(3.0), 1e-9);
}

}  // namespace
}  // namespace meltproof::imaging

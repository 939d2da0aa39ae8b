// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "validation/linescan/grain.hpp"
#include "validation/linescan/synthetic_track.hpp"

namespace meltproof::validation {
namespace {

bool nowhere(const Point&) { return false; }

TEST(SampledLine, OfAUniformConcentrationIsThatEverywhere) {
  const auto track = synthetic_track([](const Point&) { return 0.3; }, nowhere);
  const auto line = sample_line(track, {20e-6, -20e-6, -20e-6}, {20e-6, 20e-6, -20e-6}, 1e-6);
  ASSERT_EQ(line.position.size(), 41u);
  EXPECT_NEAR(line.position.back(), 40e-6, 1e-15);
  for (const double c : line.concentration) {
    EXPECT_NEAR(c, 0.3, 1e-12);
  }
}

TEST(SampledLine, FollowsALinearConcentration) {
  const auto track = synthetic_track([](const Point& p) { return 0.5 + 1e4 * p[1]; }, nowhere);
  const auto line = sample_line(track, {20e-6, -20e-6, -20e-6}, {20e-6, 20e-6, -20e-6}, 1e-6);
  for (std::size_t i = 0; i < line.position.size(); ++i) {
    EXPECT_NEAR(line.concentration[i], 0.3 + 1e4 * line.position[i], 2e-4);
  }
}

TEST(SampledLine, HasGapsOutsideTheMaterial) {
  const auto track = synthetic_track([](const Point&) { return 1.0; }, nowhere);
  const auto line = sample_line(track, {20e-6, 1e-6, -10e-6}, {20e-6, 1e-6, 10e-6}, 1e-6);
  EXPECT_FALSE(std::isnan(line.concentration[9]));  // z = -1 um
  EXPECT_TRUE(std::isnan(line.concentration[11]));  // z = +1 um
  EXPECT_THROW(sample_line(track, {0, 0, 1e-3}, {0, 0, 2e-3}, 1e-6), InputError);
  EXPECT_THROW(sample_line(track, {0, 0, 0}, {0, 0, 0}, 1e-6), InputError);
}

/// Two grains of 4 um in reach of each other, one near the edge at y = 30 um, and a third unmolten
/// one.
bool three_grains(const Point& p) {
  const auto inside = [&p](double x, double y, double z) {
    return std::hypot(p[0] - x, p[1] - y, p[2] - z) < 4.1e-6;
  };
  return inside(10e-6, 22e-6, -6e-6) || inside(10e-6, -4e-6, -6e-6) || inside(30e-6, 36e-6, -6e-6);
}

TEST(GrainRule, PicksTheMoltenGrainNearestToTheEdge) {
  const auto track = synthetic_track([](const Point&) { return 0.0; }, three_grains);
  EXPECT_EQ(find_grains(track).size(), 3u);
  const auto grain = grain_at_pool_edge(track);
  ASSERT_TRUE(grain);
  EXPECT_NEAR(grain->centre[0], 10e-6, 1e-12);
  EXPECT_NEAR(grain->centre[1], 22e-6, 1e-12);
  EXPECT_NEAR(grain->edge_high, 29e-6, 1e-12);  // the last molten particle's centre
  EXPECT_NEAR(grain->edge_distance(), 7e-6, 1e-12);
  EXPECT_EQ(grain->melted, 1);
}

/// One particle of the additive that melted on its own, in loose powder beside the molten zone.
SolidifiedTrack with_a_loose_grain() {
  auto track = synthetic_track([](const Point&) { return 0.0; }, three_grains);
  const Point loose{10e-6, 38e-6, 11e-6};
  track.position.push_back(loose);
  track.first_position.push_back(loose);
  track.identity.push_back(static_cast<std::int64_t>(track.identity.size()));
  track.origin.push_back(2);
  track.melted.push_back(1);
  track.concentration.push_back(1);
  return track;
}

// AlSi10Mg melts 800 K before 316L, so a grain that melted need not have been in the pool.
TEST(GrainRule, PassesOverAGrainThatMeltedAloneInLoosePowder) {
  const auto grain = grain_at_pool_edge(with_a_loose_grain());
  ASSERT_TRUE(grain);
  EXPECT_NEAR(grain->centre[1], 22e-6, 1e-12);
}

TEST(SampleLine, ALoneParticleIsMetalAndTheVoidBesideItIsNot) {
  const auto profile =
      sample_line(with_a_loose_grain(), {10e-6, 38e-6, 11e-6}, {10e-6, 28e-6, 11e-6}, 1e-6);
  EXPECT_EQ(profile.concentration.front(), 1);
  EXPECT_TRUE(std::isnan(profile.concentration[3]));
}

TEST(GrainRule, RunsDownOrTowardsTheMiddle) {
  const auto grain =
      *grain_at_pool_edge(synthetic_track([](const Point&) { return 0.0; }, three_grains));
  EXPECT_NEAR(line_end(grain, Direction::depth, 10e-6)[2], grain.centre[2] - 10e-6, 1e-12);
  EXPECT_NEAR(line_end(grain, Direction::lateral, 10e-6)[1], 12e-6, 1e-12);
}

TEST(GrainRule, FindsNothingWhereNoGrainMelted) {
  EXPECT_FALSE(grain_at_pool_edge(synthetic_track([](const Point&) { return 0.0; }, nowhere)));
  EXPECT_FALSE(grain_at_pool_edge(synthetic_track([](const Point&) { return 0.0; },
                                                  [](const Point& p) { return p[1] > 32e-6; })));
}

}  // namespace
}  // namespace meltproof::validation

// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/linescan/strip.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "validation/linescan/budget.hpp"
#include "validation/linescan/synthetic_track.hpp"

namespace meltproof::validation {
namespace {

bool nowhere(const Point&) { return false; }

/// A lateral line in the middle of the synthetic plate, seen along the scan.
Strip lateral_strip(double width, double depth) {
  Strip strip;
  strip.start = {20e-6, -20e-6, -20e-6};
  strip.end = {20e-6, 20e-6, -20e-6};
  strip.step = 2e-6;
  strip.width = width;
  strip.beam = {1, 0, 0};
  strip.depth = [depth](double) { return depth; };
  strip.density = [](double) { return 7800.0; };
  return strip;
}

TEST(Strip, OfNoWidthAndDepthIsTheLine) {
  const auto track = synthetic_track([](const Point& p) { return 0.5 + 1e4 * p[1]; }, nowhere);
  const auto strip = lateral_strip(0, 0);
  const auto profile = sample_strip(track, strip);
  const auto line = sample_line(track, strip.start, strip.end, strip.step);
  ASSERT_EQ(profile.mean.size(), line.concentration.size());
  for (std::size_t i = 0; i < profile.mean.size(); ++i) {
    EXPECT_DOUBLE_EQ(profile.mean[i], line.concentration[i]);
    EXPECT_EQ(profile.scatter[i], 0);
  }
  EXPECT_EQ(profile.samples, 1u);
}

// C rises by 1e4 per metre into the material: the mean over 6 um is that at 3 um, and the samples
// scatter like a uniform distribution, extent / sqrt(12).
TEST(Strip, AveragesOverItsDepthAlongTheBeam) {
  const auto track = synthetic_track([](const Point& p) { return 1e4 * p[0]; }, nowhere);
  const auto profile = sample_strip(track, lateral_strip(0, 6e-6));
  EXPECT_NEAR(profile.on_line[10], 0.20, 2e-3);
  EXPECT_NEAR(profile.mean[10], 0.23, 2e-3);
  EXPECT_NEAR(profile.scatter[10], 0.06 / std::sqrt(12.0), 2e-3);
}

TEST(Strip, AveragesOverItsWidthInTheSection) {
  const auto track = synthetic_track(
      [](const Point& p) { return 0.5 + 1e9 * (p[2] + 20e-6) * (p[2] + 20e-6); }, nowhere);
  const auto profile = sample_strip(track, lateral_strip(12e-6, 0));
  // The mean of a parabola over +-6 um lies 1e9 x 36e-12 / 3 above its foot.
  EXPECT_NEAR(profile.mean[10] - profile.on_line[10], 0.012, 1e-3);
}

TEST(Strip, WeighsByMass) {
  // Left half steel, right half additive, seen across: by mass the lighter one counts less.
  const auto track =
      synthetic_track([](const Point& p) { return p[2] > -20e-6 ? 1.0 : 0.0; }, nowhere);
  auto strip = lateral_strip(20e-6, 0);
  strip.density = [](double c) { return c > 0.5 ? 2700.0 : 7800.0; };
  EXPECT_NEAR(sample_strip(track, strip).mean[10], 2700.0 / (2700 + 7800), 0.05);
}

TEST(Strip, SamplesBeyondItsEndsWhereThereIsMaterial) {
  const auto track = synthetic_track([](const Point&) { return 0.3; }, nowhere);
  auto strip = lateral_strip(2e-6, 2e-6);
  strip.margin = 30e-6;  // the plate ends 20 um beyond the line
  const auto profile = sample_strip(track, strip);
  EXPECT_NEAR(profile.position.front(), -30e-6, 1e-12);
  EXPECT_NEAR(profile.position.back(), 70e-6, 1e-12);
  EXPECT_TRUE(std::isnan(profile.mean.front()));
  EXPECT_NEAR(profile.mean[10], 0.3, 1e-12);  // at -10 um
  EXPECT_NEAR(profile.mean[30], 0.3, 1e-12);
}

TEST(BeamDirection, StandsAcrossTheLine) {
  const Point origin{}, across{0, 1, 0}, down{0, 0, -1}, along{1, 0, 0}, slanted{1, 1, 0};
  EXPECT_EQ(beam_direction("", origin, across), (Point{1, 0, 0}));
  EXPECT_EQ(beam_direction("", origin, down), (Point{1, 0, 0}));
  EXPECT_EQ(beam_direction("", origin, along), (Point{0, 1, 0}));
  EXPECT_EQ(beam_direction("", origin, slanted), (Point{0, 0, -1}));
  EXPECT_EQ(beam_direction("-x", origin, down), (Point{-1, 0, 0}));
  EXPECT_THROW(beam_direction("x", origin, along), InputError);
  EXPECT_THROW(beam_direction("w", origin, along), InputError);
}

TEST(Budget, AddsItsPartsInQuadrature) {
  LineBudget budget;
  budget.strip = {0.03, 0};
  budget.numerical = {0.04, 0};
  EXPECT_TRUE(budget.total().empty());  // of the measurement nothing is known
  budget.counting = {0.12, 0.01};
  EXPECT_DOUBLE_EQ(budget.total()[0], 0.13);
  budget.reported = {0.05, 0.02};
  EXPECT_EQ(budget.measured(), (std::vector<double>{0.12, 0.02}));  // the larger one
  budget.reported = {0.05, 0};
  EXPECT_EQ(budget.measured(), budget.counting);  // a zero is no uncertainty
}

TEST(Budget, ScatterOfAStripShrinksWithTheParticlesItHolds) {
  EXPECT_DOUBLE_EQ(strip_uncertainty(0.2, 1e-6, 2e-6, 10e-6), 0.2);
  EXPECT_DOUBLE_EQ(strip_uncertainty(0.2, 2e-6, 2e-6, 1e-6), 0.1);
}

TEST(Budget, AnEdgeWithinOneSpacing) {
  const std::vector<double> x = {0, 1, 2, 3}, c = {0, 0.1, 0.2, std::nan("")};
  const auto u = edge_uncertainty(x, c, 2);
  EXPECT_NEAR(u[1], 0.1 * 2 / std::sqrt(12.0), 1e-15);
  EXPECT_EQ(u[2], 0);
}

TEST(Budget, ErrorsOfV20) {
  LineBudget budget;
  budget.reported = {0.04, 0.04, 0.04, 0.04};
  budget.strip = {0.03, 0.03, 0.03, 0.03};
  ComparisonUncertainty parts;
  const auto v = line_validation_error(0.05, 0.5, budget, {}, 2, parts);
  EXPECT_DOUBLE_EQ(*parts.data, 0.02);       // independent points: over sqrt(4)
  EXPECT_DOUBLE_EQ(*parts.numerical, 0.03);  // common to all of them
  EXPECT_DOUBLE_EQ(v.uncertainty, std::hypot(0.02, 0.03));
  EXPECT_FALSE(v.complete);  // u_input is not known here
  line_validation_error(0.05, 0.5, budget, 0.1, 2, parts);
  EXPECT_DOUBLE_EQ(*parts.data, std::hypot(0.02, 0.05));
}

}  // namespace
}  // namespace meltproof::validation

// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/level_doubt.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "imaging/meltpool/budget.hpp"

namespace meltproof::imaging {
namespace {

// Two standard uncertainties reach both ends of 0.15 to 0.5, and the farther one exactly.
TEST(AnAssumedEmissivity, IsAsUncertainAsWhatIsPublished) {
  for (const double e : {0.1, 0.2, 0.3, 0.5, 1.0}) {
    const double u = u_assumed_emissivity(e);
    EXPECT_LE(e * std::exp(-2 * u), 0.15 * (1 + 1e-12));
    EXPECT_GE(e * std::exp(2 * u), 0.5 * (1 - 1e-12));
    EXPECT_GE(u, 0.25 * std::log(0.5 / 0.15) - 1e-12);
  }
  EXPECT_NEAR(u_assumed_emissivity(0.3), std::log(2.0) / 2, 1e-12);
}

TEST(LevelDoubt, AddsUpWhatTheLevelRestsOn) {
  RecordingHeader h;
  h.radiometry = Radiometry{};
  Level level;
  level.kind = LevelKind::radiometry;
  level.reference_temperature = 1683;
  level.emissivity = 0.3;
  BudgetSettings s;
  s.u_transmission = 0;
  s.u_emissivity = 0;
  // d ln S / d ln T is 2.56 between 3 and 5 um there.
  EXPECT_NEAR(level_doubt(h, level, s, 0).u_log, 2.56 * 5 / 1683, 2e-5);
  s.u_reference_temperature = 0;
  s.u_emissivity = 0.1;
  EXPECT_NEAR(level_doubt(h, level, s, 0).u_log, 0.1, 1e-12);
  s.u_emissivity.reset();
  EXPECT_NEAR(level_doubt(h, level, s, 0).u_log, std::log(2.0) / 2, 1e-12);
  EXPECT_NE(level_doubt(h, level, s, 0).how.find("assumed"), std::string::npos);
  level.kind = LevelKind::temperature;
  h.calibration["emissivity"] = 0.3;
  EXPECT_NEAR(level_doubt(h, level, s, 0).u_log, std::log(2.0) / 2 / steepness_of_steel, 1e-12);
  level.kind = LevelKind::recording;
  EXPECT_EQ(level_doubt(h, level, s, 0.02).u_log, 0.02);
  level.kind = LevelKind::given;
  s.u_level = 0.03;
  EXPECT_EQ(level_doubt(h, level, s, 0).u_log, 0.03);
}

TEST(LevelEffect, FollowsTheDimensionsWhereNoStraightLineDoes) {
  // A shoulder: the length jumps where the level is raised by 0.4.
  const auto length = [](double shift) { return (shift < 0.4 ? 15 : 10) - 2 * shift; };
  const LevelEffect effect(0.3, {15, 7}, [&](double shift) -> std::optional<Effect> {
    return Effect{length(shift), 7};
  });
  for (const double shift : {-0.9, -0.31, 0.0, 0.2, 0.5, 0.8})
    EXPECT_NEAR(effect(shift).length, length(shift) - 15, 1e-9) << shift;
  EXPECT_EQ(effect(0.5).depth, 0);
  EXPECT_EQ(LevelEffect(0, {15, 7}, [](double) { return Effect{1, 1}; })(0.5).length, 0);
}

TEST(LevelEffect, GoesOnAsAPowerWhereNothingCanBeMeasured) {
  const LevelEffect effect(0.3, {15, 7}, [](double shift) -> std::optional<Effect> {
    if (shift < -0.35) return std::nullopt;  // the region leaves the image
    if (shift > 0.7) return Effect{};        // nothing reaches the level
    return Effect{15 * std::exp(-0.5 * shift), 7 * std::exp(-0.3 * shift)};
  });
  EXPECT_NEAR(effect(-0.8).length, 15 * std::expm1(0.4), 1e-9);
  EXPECT_NEAR(effect(-0.8).depth, 7 * std::expm1(0.24), 1e-9);
  EXPECT_NEAR(effect(0.9).length, -15, 1e-9);
  EXPECT_NEAR(effect(2).length, -15, 1e-9);
  // Where no other level can be measured, as behind an analytic pool.
  const LevelEffect unseen(0.3, {15, 7}, [](double) { return std::nullopt; });
  EXPECT_NEAR(unseen(-0.6).length, 15 * std::expm1(0.47 * 0.6), 1e-9);
  EXPECT_LT(unseen(0.6).length, -3);
}

}  // namespace
}  // namespace meltproof::imaging

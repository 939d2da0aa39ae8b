// SPDX-License-Identifier: GPL-3.0-or-later
// Random scenes of known truth, 200 of a kind: how far lengths and depths are off, and how often
// their 95 % intervals hold the truth. Minutes; label long.
#include <algorithm>
#include <array>
#include <cstdint>

#include <gtest/gtest.h>

#include "imaging/camera/scenes.hpp"

namespace meltproof::imaging {
namespace {

TEST(TwoHundredScenes, WithTheLevelGiven) {
  Scenes scenes(20260101);
  Tally tally;
  for (int i = 0; i < 200; ++i) {
    PassageSettings s = scenes.next(i);
    set_signal_to_noise(s, scenes.signal_to_noise);
    const FilmedPassage film = film_passage(s);
    MeasurementRequest r = request_for(s);
    r.level.reference_temperature.reset();
    r.level.level = film.solid_signal;
    r.search = ReferenceSearch::off;
    tally.add(measure_recording(recording_of(film, s), r), film);
  }
  tally.say("level given");
  EXPECT_EQ(tally.close, 200);
  EXPECT_EQ(tally.depth_close, 200);
  EXPECT_GE(tally.depth_covered, 180);
  EXPECT_GE(tally.covered, 180);
  EXPECT_LE(tally.covered, 198);
}

/// S* is read from a feature that is hardly wider than the point spread, which must be measured for
/// it: the scenes' point spreads are as uncertain as meltproof-calibrate leaves them.
/// @param uncertainty the largest half width of a 95 % interval that is given, relative; @param
/// alloy_known whether the freezing heat is known as well as a material's file tells it.
Tally with_the_reference_signal_found(std::uint64_t seed, double uncertainty, bool alloy_known) {
  constexpr double calibrated = 0.04;  // px
  Scenes scenes(seed, calibrated);
  Tally tally;
  std::array<Tally, 4> of_kind;
  for (int i = 0; i < 200; ++i) {
    PassageSettings s = scenes.next(i);
    if (i % 4 < 2) {
      s.camera.emissivity_liquid = scenes.uniform(0.2, 0.33);
      s.camera.emissivity_solid = 1.5 * s.camera.emissivity_liquid;
    } else {
      s.solidification.latent_heat = 372;
      s.source.absorbed_power = scenes.uniform(62, 85);
      s.source.reference_temperature = 1683;
    }
    set_signal_to_noise(s, scenes.signal_to_noise);
    const FilmedPassage film = film_passage(s);
    MeasurementRequest r = request_for(s);
    r.search = ReferenceSearch::required;
    r.budget.u_point_spread = calibrated;
    r.rules.uncertainty = uncertainty;
    if (alloy_known && s.solidification.latent_heat > 0) {
      // Off by as much as it is said to be uncertain.
      const double off = r.rules.u_freezing_heat * std::clamp(scenes.normal(), -2.5, 2.5);
      r.rules.freezing_heat =
          (s.solidification.latent_heat + 50) / s.source.reference_temperature * (1 + off);
    }
    const Measurement m = measure_recording(recording_of(film, s), r);
    for (Tally* t : {&tally, &of_kind[static_cast<std::size_t>(i % 4)]}) {
      if (m.budget && m.reference_used)
        t->add(m, film);
      else
        ++t->none;
    }
  }
  const std::array<const char*, 4> kinds{"  step, SNR 100", "  step, SNR 20",
                                         "  latent heat, SNR 100", "  latent heat, SNR 20"};
  for (std::size_t k = 0; k < kinds.size(); ++k) of_kind[k].say(kinds[k]);
  return tally;
}

/// Depths within a pixel, and 95 % intervals that hold what they say.
void expect_intervals(const Tally& tally) {
  EXPECT_EQ(tally.depth_close, tally.n);
  EXPECT_GE(tally.depth_covered, 0.90 * tally.n);
  EXPECT_GE(tally.covered, 0.90 * tally.n);
  EXPECT_LE(tally.covered, 0.99 * tally.n);
}

// A length that must be within 2 %, come what may: three of its standard deviations are asked to
// be, or the sentence why not.
TEST(TwoHundredScenes, WithTheReferenceSignalFoundSoWellThatAllAreWithinTwoPercent) {
  const Tally tally = with_the_reference_signal_found(20260102, 0.02 * 2 / 3, false);
  tally.say("reference signal found, three standard deviations within 2 %");
  EXPECT_EQ(tally.close, tally.n);
  expect_intervals(tally);
  EXPECT_GE(tally.n, 100);
}

// What `uncertainty` says: 95 % of the lengths are within 2 %, so the odd one is not.
TEST(TwoHundredScenes, WithTheReferenceSignalFoundAndTheAlloyKnown) {
  const Tally tally = with_the_reference_signal_found(20260103, 0.02, true);
  tally.say("reference signal found, alloy known, 95 % interval within 2 %");
  EXPECT_GE(tally.close, 0.95 * tally.n);
  expect_intervals(tally);
  EXPECT_GE(tally.n, 140);
}

// As a user has it who says nothing of the alloy: three standard deviations are half as much again
// as half of a 95 % interval.
TEST(TwoHundredScenes, WithTheReferenceSignalFoundByDefault) {
  const double uncertainty = ReferenceRules{}.uncertainty;
  const Tally tally = with_the_reference_signal_found(20260104, uncertainty, false);
  tally.say("reference signal found, as by default");
  EXPECT_LE(tally.worst, 1.5 * uncertainty);
  EXPECT_GE(tally.close, 0.95 * tally.n);
  expect_intervals(tally);
  EXPECT_GE(tally.n, 150);
}

// Nobody has measured the emissivity: 0.3 is assumed, the scenes have 0.2 to 0.5.
TEST(TwoHundredScenes, WithAnAssumedEmissivity) {
  for (const bool latent_heat : {false, true}) {
    Scenes scenes(20260103);
    Tally tally;
    for (int i = 0; i < 200; ++i) {
      PassageSettings s = scenes.next(i);
      if (latent_heat) {
        s.solidification.latent_heat = 372;
        s.source.absorbed_power = scenes.uniform(62, 85);
        s.source.reference_temperature = 1683;
      }
      set_signal_to_noise(s, scenes.signal_to_noise);
      const FilmedPassage film = film_passage(s);
      MeasurementRequest r = request_for(s);
      r.search = ReferenceSearch::off;
      tally.add(measure_recording(with_assumed_emissivity(film, s, 0.3), r), film);
    }
    tally.say(latent_heat ? "emissivity assumed, latent heat" : "emissivity assumed");
    EXPECT_GE(tally.covered, 180);
    EXPECT_GE(tally.depth_covered, 180);
  }
}

}  // namespace
}  // namespace meltproof::imaging

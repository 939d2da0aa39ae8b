// SPDX-License-Identifier: GPL-3.0-or-later
// Where the recording itself shows no phase boundary, the level rests on an emissivity that nobody
// has measured, and the interval must say so.
#include <cmath>

#include <gtest/gtest.h>

#include "imaging/camera/scenes.hpp"
#include "imaging/meltpool/report_budget.hpp"

namespace meltproof::imaging {
namespace {

double half_width(const Measurement& m) {
  return 0.5 * (m.budget->length.high - m.budget->length.low) / m.budget->length.value;
}

// Published emissivities of liquid metals reach from 0.15 to 0.5; 0.3 is assumed. Ten scenes here,
// 200 in coverage_test.
TEST(AssumedEmissivity, TheIntervalsHoldTheTruth) {
  Scenes scenes(770201);
  Tally tally;
  for (int i = 0; i < 10; ++i) {
    PassageSettings s = scenes.next(i);
    set_signal_to_noise(s, scenes.signal_to_noise);
    const FilmedPassage film = film_passage(s);
    MeasurementRequest r = request_for(s);
    r.search = ReferenceSearch::off;
    const Measurement m = measure_recording(with_assumed_emissivity(film, s, 0.3), r);
    ASSERT_TRUE(m.budget) << m.analysis.reason;
    EXPECT_FALSE(m.emissivity_independent());
    tally.add(m, film);
    // Not by being without limits: +-33 % on average.
    EXPECT_LT(half_width(m), 0.5);
  }
  tally.say("emissivity assumed");
  EXPECT_GE(tally.covered, 9);
  EXPECT_GE(tally.depth_covered, 9);
}

// A front that is placed less well than is asked still is the front: an assumed emissivity knows
// the length less well. Where it knows it better, or the front is demanded, the front gives way.
TEST(AssumedEmissivity, GivesWayToAVagueFront) {
  Scenes scenes(770204);
  PassageSettings s = scenes.next(0);
  s.solidification.latent_heat = 372;
  s.source.absorbed_power = 75;
  s.source.reference_temperature = 1683;
  s.camera.emissivity_liquid = s.camera.emissivity_solid = 0.45;
  set_signal_to_noise(s, 20);
  const FilmedPassage film = film_passage(s);
  const Recording recording = with_assumed_emissivity(film, s, 0.3);
  MeasurementRequest r = request_for(s);
  r.budget.u_point_spread = 0.04;
  r.rules.uncertainty = 0.002;
  const Measurement vague = measure_recording(recording, r);
  ASSERT_TRUE(vague.reference_used) << vague.reference.reason;
  EXPECT_NE(vague.vague.find("0.2 % are allowed"), std::string::npos) << vague.vague;
  EXPECT_NE(caution(vague).find("known even less"), std::string::npos);
  EXPECT_EQ(reference_json(vague, recording.header())["vague"], vague.vague);
  EXPECT_LE(vague.budget->length.low, film.length);
  EXPECT_GE(vague.budget->length.high, film.length);
  r.rules.uncertainty = 0.05;
  const Measurement sure = measure_recording(recording, r);
  EXPECT_TRUE(sure.reference_used);
  EXPECT_EQ(sure.budget->length.value, vague.budget->length.value);
  EXPECT_EQ(caution(sure), "");
  EXPECT_TRUE(reference_json(sure, recording.header())["vague"].is_null());
  r.rules.uncertainty = 0.002;
  r.budget.u_emissivity = r.budget.u_transmission = 1e-4;
  const Measurement known = measure_recording(recording, r);
  EXPECT_FALSE(known.reference_used);
  EXPECT_EQ(caution(known), "");
  EXPECT_NE(known.reference.reason.find("0.2 % are allowed"), std::string::npos);
  r.search = ReferenceSearch::required;
  EXPECT_FALSE(measure_recording(recording, r).analysis.found);
}

// With 10 %, as the budget took every emissivity before, half of such intervals miss.
TEST(AssumedEmissivity, AStatedUncertaintyIsTaken) {
  Scenes scenes(770202);
  PassageSettings s = scenes.next(0);
  s.camera.emissivity_liquid = s.camera.emissivity_solid = 0.48;
  set_signal_to_noise(s, 100);
  const FilmedPassage film = film_passage(s);
  const Recording recording = with_assumed_emissivity(film, s, 0.3);
  MeasurementRequest r = request_for(s);
  r.search = ReferenceSearch::off;
  const Measurement unknown = measure_recording(recording, r);
  EXPECT_LE(unknown.budget->length.low, film.length);
  r.budget.u_emissivity = 0.1;
  const Measurement stated = measure_recording(recording, r);
  EXPECT_GT(stated.budget->length.low, film.length);
  EXPECT_LT(half_width(stated), 0.4 * half_width(unknown));
  EXPECT_EQ(stated.budget->length.value, unknown.budget->length.value);
}

// The level that is assumed lies behind the shoulder of latent heat, the true one before it.
TEST(AssumedEmissivity, TheIntervalReachesAcrossAShoulder) {
  Scenes scenes(770203);
  PassageSettings s = scenes.next(0);
  s.camera.emissivity_liquid = s.camera.emissivity_solid = 0.45;
  s.solidification.latent_heat = 372;
  s.source.absorbed_power = 75;
  s.source.reference_temperature = 1683;
  set_signal_to_noise(s, 100);
  const FilmedPassage film = film_passage(s);
  MeasurementRequest r = request_for(s);
  r.search = ReferenceSearch::off;
  const Measurement m = measure_recording(with_assumed_emissivity(film, s, 0.3), r);
  EXPECT_GT(m.budget->length.value, 1.4 * film.length) << "the level lies behind the shoulder";
  EXPECT_LE(m.budget->length.low, film.length);
  EXPECT_GE(m.budget->length.high, film.length);
}

// Nine frames are too few to take blur off; the level is as uncertain there.
TEST(AssumedEmissivity, CountsWhereNothingIsCorrected) {
  Scenes scenes(770204);
  PassageSettings s = scenes.next(0);
  s.source.frames = 9;
  s.start = 30;
  s.camera.emissivity_liquid = s.camera.emissivity_solid = 0.4;
  set_signal_to_noise(s, 100);
  const FilmedPassage film = film_passage(s);
  const Measurement m = measure_recording(with_assumed_emissivity(film, s, 0.3), request_for(s));
  ASSERT_TRUE(m.budget);
  EXPECT_FALSE(m.budget->corrected);
  EXPECT_LE(m.budget->length.low, film.length);
  EXPECT_GE(m.budget->length.high, film.length);
  EXPECT_GT(half_width(m), 0.2);
}

// A recording of temperatures has the emissivity in it.
TEST(AssumedEmissivity, CountsInTemperaturesToo) {
  Scenes scenes(770205);
  PassageSettings s = scenes.next(0);
  s.camera.emissivity_liquid = s.camera.emissivity_solid = 0.4;
  set_signal_to_noise(s, 100);
  const FilmedPassage film = film_passage(s);
  FilmedPassage kelvin = film;
  Radiometry software = camera_radiometry(s.camera);
  software.emissivity = 0.3;
  const BandTable band(software.band_lower, software.band_upper);
  for (auto& frame : kelvin.frames)
    for (float& v : frame) {
      const double t = temperature(software, band, static_cast<double>(v));
      v = static_cast<float>(std::isfinite(t) ? t : 293.15);
    }
  Recording recording = recording_of(kelvin, s);
  recording.header().radiometry.reset();
  recording.header().quantity = SignalQuantity::temperature;
  recording.header().unit = "K";
  recording.header().calibration["emissivity"] = 0.3;
  const Measurement m = measure_recording(recording, request_for(s));
  ASSERT_TRUE(m.budget) << m.analysis.reason;
  EXPECT_GT(m.budget->length.value, 1.1 * film.length);
  EXPECT_LE(m.budget->length.low, film.length);
  EXPECT_NE(would_narrow(m).find("exported as counts"), std::string::npos);
}

TEST(AssumedEmissivity, WhatWouldNarrowTheIntervalIsSaid) {
  Scenes scenes(770206);
  PassageSettings s = scenes.next(0);
  set_signal_to_noise(s, 100);
  const FilmedPassage film = film_passage(s);
  const Recording recording = recording_of(film, s);
  MeasurementRequest r = request_for(s);
  const Measurement assumed = measure_recording(recording, r);
  const std::string said = would_narrow(assumed);
  for (const char* words : {"MATERIAL", "CALIBRATION", "LEVEL", "u_emissivity"})
    EXPECT_NE(said.find(words), std::string::npos) << said;
  EXPECT_EQ(reference_json(assumed, recording.header())["would_narrow"], said);
  r.level.reference_temperature.reset();
  r.level.level = film.solid_signal;
  const Measurement given = measure_recording(recording, r);
  EXPECT_EQ(would_narrow(given), "");
  EXPECT_TRUE(reference_json(given, recording.header())["would_narrow"].is_null());
}

}  // namespace
}  // namespace meltproof::imaging

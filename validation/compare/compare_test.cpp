// SPDX-License-Identifier: GPL-3.0-or-later
// Every result in this file is synthetic: made up to exercise the runner.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "validation/compare/synthetic_results.hpp"

namespace meltproof::validation {
namespace {

TEST_F(Results, ADifferenceIsJudgedByItsUncertainty) {
  Row row = width_row();  // D = 127.7 um, u_D = 6.6 %
  put("desk/track.json", {{"width_m", 120e-6}});
  const auto near = run_row(row, places_);
  EXPECT_EQ(near.verdict, "agrees");
  EXPECT_NEAR(*near.numbers.error, -7.7, 1e-9);
  EXPECT_NEAR(*near.numbers.u_val, 0.066 * 127.7, 1e-9);
  EXPECT_NEAR(*near.numbers.upper, -7.7 + 2 * 0.066 * 127.7, 1e-9);
  EXPECT_EQ(near.failure, "");
  EXPECT_NE(near.source.find("Hofmann"), std::string::npos);
  put("desk/track.json", {{"width_m", 100e-6}});
  const auto far = run_row(row, places_);
  EXPECT_EQ(far.verdict, "differs");
  EXPECT_NE(far.failure.find("\"width\""), std::string::npos);
  row.verdict = "differs";
  EXPECT_EQ(run_row(row, places_).failure, "");
}

TEST_F(Results, TheSpacingEntersTheNumericalUncertainty) {
  Row row = width_row();
  row.simulated.spacing = "/spacing_m";
  row.simulated.uncertainty = "/u_m";
  put("desk/track.json", {{"width_m", 120e-6}, {"spacing_m", 10e-6}, {"u_m", 3e-6}});
  EXPECT_NEAR(*run_row(row, places_).numbers.u_num, std::sqrt(100.0 / 6 + 9), 1e-9);
}

TEST_F(Results, AStudyTakesThePlaceOfTheSpacing) {
  Row row = width_row();
  row.simulated.spacing = "/spacing_m";
  row.simulated.uncertainty = "/u_m";
  row.simulated.study = "width";
  put("desk/track.json", {{"width_m", 120e-6}, {"spacing_m", 10e-6}, {"u_m", 3e-6}});
  const auto without = run_row(row, places_);
  EXPECT_NEAR(*without.numbers.u_num, std::sqrt(100.0 / 6 + 9), 1e-9);
  EXPECT_EQ(without.numbers.details["u_val_is_lower_bound"], true);
  places_.studies = folder_ / "studies.json";
  put("studies.json", {{"quantities", {{"width", {{"relative_u", 0.05}}}}}});
  EXPECT_NEAR(*run_row(row, places_).numbers.u_num, std::hypot(3, 6), 1e-9);
  put("studies.json", {{"quantities", {{"width", {{"relative_u", nullptr}}}}}});
  EXPECT_NEAR(*run_row(row, places_).numbers.u_num, std::sqrt(100.0 / 6 + 9), 1e-9);
}

/// studies.json with synthetic shares: absorptivity 8 % of the width (sensitivity 0.6), a law 3 %.
json with_inputs(const std::vector<std::string>& missing) {
  return {{"quantities", {{"width", {{"relative_u", 0.05}}}}},
          {"inputs",
           {{"width",
             {{"relative_u", 0.0},
              {"parts", {{"absorptivity", 0.08}, {"law", 0.03}}},
              {"sensitivities", {{"absorptivity", 0.6}, {"law", nullptr}}},
              {"missing", missing}}}}}};
}

TEST_F(Results, UncertainInputsEnterTheValidationUncertainty) {
  Row row = width_row();
  row.simulated.study = "width";
  put("desk/track.json", {{"width_m", 120e-6}});
  places_.studies = folder_ / "studies.json";
  put("studies.json", with_inputs({}));
  const auto all = run_row(row, places_).numbers;
  EXPECT_NEAR(*all.u_input, 120 * std::hypot(0.08, 0.03), 1e-9);
  EXPECT_NEAR(*all.u_val, std::hypot(6.0, *all.u_input, 0.066 * 127.7), 1e-9);
  EXPECT_EQ(all.details["u_val_is_lower_bound"], false);
  EXPECT_TRUE(all.details["not_evaluated"].empty());
  put("studies.json", with_inputs({"radius"}));
  const auto part = run_row(row, places_);
  EXPECT_EQ(part.numbers.details["u_val_is_lower_bound"], true);
  EXPECT_EQ(part.numbers.details["inputs_not_evaluated"], json::array({"radius"}));
  EXPECT_NE(part.finding.find("lower bound: u_input not fully"), std::string::npos);
}

TEST_F(Results, ARowOfAnotherMaterialHasItsOwnUncertainInputs) {
  Row row = width_row();
  row.simulated.study = "width";
  put("desk/track.json", {{"width_m", 120e-6}});
  places_.studies = folder_ / "studies.json";
  put("studies.json", with_inputs({"radius"}));
  row.simulated.inputs = {"absorptivity = 21 %", "law = 0 %", "radius = 0 %"};
  const auto own = run_row(row, places_).numbers;
  EXPECT_NEAR(*own.u_input, 120 * 0.6 * 0.21, 1e-9);
  EXPECT_EQ(own.details["u_val_is_lower_bound"], false);
  for (const char* wrong : {"law = 4 %", "colour = 0 %", "absorptivity", "absorptivity = 3 um"}) {
    row.simulated.inputs = {wrong};
    EXPECT_EQ(run_row(row, places_).verdict, "not computed") << wrong;
  }
}

TEST_F(Results, AMeasurementWithoutSigmaIsNamedAndNotTakenAsExact) {
  Row row = width_row();
  row.input_uncertainty = 1.0;
  row.simulated.uncertainty = "/u";
  row.reference = {.campaign = "tracks316l", .file = "trapp2017.csv", .column = "width"};
  row.reference.where = {"power = 99"};
  put("desk/track.json", {{"width_m", 126e-6}, {"u", 2e-6}});
  const auto result = run_row(row, places_);
  EXPECT_FALSE(result.numbers.u_data);
  EXPECT_EQ(result.numbers.details["not_evaluated"], json::array({"u_D"}));
  EXPECT_NE(result.finding.find("lower bound: u_D not"), std::string::npos);
}

TEST_F(Results, AProfileMayBeKnownToGiveSomethingElse) {
  ComparisonTable table;
  Row row = error_row();
  row.simulated = {.file = "track_a/result.json", .value = "/e"};
  table.rows.push_back(row);
  Row other = row;
  other.name = "other";
  other.simulated.file = "track_b/result.json";
  table.rows.push_back(other);
  table.exceptions.push_back(
      {.profile = "smoke", .track = "track_a", .verdict = "left out", .reason = "too long"});
  table.exceptions.push_back(
      {.profile = "smoke", .rows = {"other"}, .verdict = "differs", .reason = "too coarse"});
  fs::create_directories(folder_ / "desk/track_b");
  put("desk/track_b/result.json", {{"e", 0.5}});
  const auto smoke = run_table(table, places_, "smoke");
  EXPECT_EQ(smoke[0].verdict, "pending");
  EXPECT_EQ(smoke[0].failure, "");
  EXPECT_EQ(smoke[1].verdict, "differs");
  EXPECT_EQ(smoke[1].failure, "");
  const auto desk = run_table(table, places_, "desk");
  EXPECT_NE(desk[0].failure, "");
  EXPECT_NE(desk[1].failure, "");
  table.exceptions.back().rows = {"nobody"};
  EXPECT_THROW(run_table(table, places_, "smoke"), InputError);
}

TEST_F(Results, AnErrorCountsBySize) {
  Row row = error_row();
  row.simulated = {.file = "a.json", .value = "/e"};
  put("desk/a.json", {{"e", -0.03}});
  EXPECT_EQ(run_row(row, places_).verdict, "differs");
}

TEST_F(Results, AMissingNumberIsNamedAndFails) {
  const Row row = width_row();
  EXPECT_NE(run_row(row, places_).failure.find("track.json is missing"), std::string::npos);
  put("desk/track.json", {{"height_m", 1}});
  EXPECT_NE(run_row(row, places_).failure.find("nothing at /width_m"), std::string::npos);
  std::ofstream(folder_ / "desk/track.json") << "{\"width_m\": 1";
  const auto broken = run_row(row, places_);
  EXPECT_EQ(broken.verdict, "not computed");
  EXPECT_NE(broken.failure.find("no JSON"), std::string::npos);
}

TEST_F(Results, ARowThatWaitsForASimulationMustBeDeclaredOnceItIsThere) {
  Row row = width_row();
  row.verdict = "pending";
  row.waits_for = "simulation";
  const auto waiting = run_row(row, places_);
  EXPECT_EQ(waiting.verdict, "pending");
  EXPECT_EQ(waiting.failure, "");
  EXPECT_EQ(waiting.numbers.measured, 127.7);
  put("desk/track.json", {{"width_m", 120e-6}});
  EXPECT_NE(run_row(row, places_).failure.find("declares \"pending\""), std::string::npos);
}

TEST_F(Results, AnEmptySlotIsPendingAndStillNeedsItsSimulation) {
  Row row = width_row();
  row.verdict = "pending";
  row.waits_for = "reference";
  row.reference = {.campaign = "wimmer2021", .file = "fig5_length.csv", .column = "length"};
  row.reference.where = {"additive = 5"};
  EXPECT_EQ(run_row(row, places_).verdict, "not computed");
  put("desk/track.json", {{"width_m", 300e-6}});
  const auto result = run_row(row, places_);
  EXPECT_EQ(result.verdict, "pending");
  EXPECT_NEAR(*result.numbers.simulated, 300, 1e-9);
  EXPECT_FALSE(result.numbers.measured || result.numbers.error);
  EXPECT_EQ(result.failure, "");
  row.verdict = "agrees";
  EXPECT_NE(run_row(row, places_).failure.find("but it is pending"), std::string::npos);
}

TEST_F(Results, ACaseIsJudgedByTheTableNotByItself) {
  const auto write = [this](double error, double asked) {
    put("verification.json", {{"cases", {{{"name", "slab"}, {"error", error}, {"asked", asked}}}}});
  };
  write(0.004, 0.01);
  EXPECT_EQ(run_row(error_row(), places_).verdict, "agrees");
  write(0.02, 0.01);
  EXPECT_EQ(run_row(error_row(), places_).verdict, "differs");
  write(0.02, 0.05);
  EXPECT_NE(run_row(error_row(), places_).failure.find("asks for 0.05"), std::string::npos);
  Row other = error_row();
  other.simulated.verification_case = "sphere";
  EXPECT_NE(run_row(other, places_).failure.find("no case \"sphere\""), std::string::npos);
}

TEST(Rules, NeedTheNumbersThatTheyCompare) {
  Row row;
  row.metric = "error_norm";
  row.rule = "within_uncertainty";
  RowNumbers numbers;
  numbers.simulated = 1;
  EXPECT_THROW(obeys(row, numbers), InputError);
  EXPECT_EQ(rule_text(row), "|E| <= 2 u_val");
}

}  // namespace
}  // namespace meltproof::validation

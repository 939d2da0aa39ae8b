// SPDX-License-Identifier: GPL-3.0-or-later
// Every result in this file is synthetic: made up to exercise the runner.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "validation/compare/metric.hpp"
#include "validation/compare/rule.hpp"
#include "validation/compare/runner.hpp"

namespace meltproof::validation {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A folder of synthetic results.
class Results : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / "synthetic_results";
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "desk");
    places_ = {folder_ / "desk", folder_ / "verification.json", "data/experiments"};
  }
  void put(const std::string& file, const json& content) const {
    std::ofstream(folder_ / file) << content;
  }
  Row width_row() const {
    Row row;
    row.name = "width";
    row.kind = "validation";
    row.quantity = "width";
    row.unit = "um";
    row.metric = "difference";
    row.rule = "within_uncertainty";
    row.verdict = "agrees";
    row.simulated = {.file = "track.json", .value = "/width_m", .unit = "m"};
    row.reference = {.campaign = "tracks316l", .file = "hofmann2026.csv", .column = "width"};
    row.reference.where = {"power = 175", "speed = 750"};
    row.has_reference = true;
    return row;
  }
  Row error_row() const {
    Row row;
    row.name = "error";
    row.metric = "error_norm";
    row.rule = "at_most";
    row.limit = 0.01;
    row.verdict = "agrees";
    row.simulated.verification_case = "slab";
    return row;
  }
  Row trend_row() const {
    Row row;
    row.name = "trend";
    row.unit = "um";
    row.metric = "trend";
    row.rule = "rises";
    row.verdict = "agrees";
    row.simulated = {
        .files = {"a.json", "b.json", "c.json"}, .value = "/l", .uncertainty = "/u", .unit = "um"};
    row.reference = {.campaign = "wimmer2021", .file = "fig5_trend.csv", .column = "length_rank"};
    row.has_reference = true;
    return row;
  }
  fs::path folder_;
  Places places_;
};

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

TEST_F(Results, ARowMayStandForSeveral) {
  ComparisonTable table;
  Row row;
  row.name = "lost_{}";
  row.title = "Particles lost, {}";
  row.for_each = {"a", "b"};
  row.metric = "number";
  row.rule = "at_least";
  row.limit = -1;
  row.verdict = "agrees";
  row.simulated = {.file = "{}.json", .value = "/height", .over = "/spacing"};
  table.rows.push_back(row);
  Row own = row;
  own.for_each.clear();
  own.name = "lost_b";
  own.simulated.file = "b.json";
  own.verdict = "differs";
  table.rows.push_back(own);
  put("desk/a.json", {{"height", -9}, {"spacing", 10}});
  put("desk/b.json", {{"height", -11}, {"spacing", 10}});
  const auto results = run_table(table, places_);
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].row.title, "Particles lost, a");
  EXPECT_NEAR(*results[0].numbers.simulated, -0.9, 1e-12);
  EXPECT_EQ(results[0].verdict, "agrees");
  EXPECT_EQ(results[1].verdict, "differs");
  EXPECT_EQ(results[1].failure, "");
}

TEST_F(Results, EveryVerificationCaseHasARowWithoutBeingTyped) {
  ComparisonTable table;
  Row row = error_row();
  row.name = "cases";
  row.every_case = true;
  row.limit = 0.1;
  row.simulated.verification_case = "{}";
  table.rows.push_back(row);
  EXPECT_NE(run_table(table, places_)[0].failure, "");
  put("verification.json",
      {{"cases",
        {{{"name", "slab"}, {"title", "Slab"}, {"error", 0.02}, {"asked", 0.01}},
         {{"name", "drop"}, {"title", "Drop"}, {"error", 0.09}, {"asked", 0.1}},
         {{"name", "loose"}, {"title", "Loose"}, {"error", 0.09}, {"asked", 0.2}},
         {{"name", "torn"},
          {"title", "Torn"},
          {"error", 0.0},
          {"asked", 0.1},
          {"broken", {"it is not at rest"}}}}},
       {"not_run", {"cavity"}}});
  const auto results = run_table(table, places_);
  ASSERT_EQ(results.size(), 5u);
  EXPECT_EQ(results[0].verdict, "differs");
  EXPECT_EQ(results[1].verdict, "agrees");
  EXPECT_EQ(results[1].row.title, "Drop");
  EXPECT_EQ(results[2].verdict, "not computed");  // asks less than the table allows
  EXPECT_EQ(results[3].verdict, "differs");
  EXPECT_NE(results[3].finding.find("not at rest"), std::string::npos);
  EXPECT_NE(results[4].failure.find("cavity"), std::string::npos);
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

TEST_F(Results, ATrendMustRiseBeyondItsScatter) {
  const auto write = [this](double a, double b, double c) {
    put("desk/a.json", {{"l", a}, {"u", 3}});
    put("desk/b.json", {{"l", b}, {"u", 3}});
    put("desk/c.json", {{"l", c}, {"u", 3}});
  };
  write(300, 320, 350);
  const auto rising = run_row(trend_row(), places_);
  EXPECT_EQ(rising.verdict, "agrees");
  EXPECT_NEAR(*rising.numbers.simulated, 20, 1e-12);
  EXPECT_EQ(rising.numbers.details["trend"], "rises");
  write(300, 304, 350);
  EXPECT_EQ(run_row(trend_row(), places_).verdict, "differs");
  EXPECT_EQ(run_row(trend_row(), places_).numbers.details["trend"], "undecided");
  write(300, 320, 290);
  EXPECT_EQ(run_row(trend_row(), places_).numbers.details["trend"], "falls");
}

TEST_F(Results, ACurveIsPendingUntilItsPointsAreThere) {
  Row row;
  row.name = "profile";
  row.metric = "curve";
  row.rule = "at_most";
  row.limit = 0.05;
  row.verdict = "pending";
  row.waits_for = "reference";
  row.simulated = {.file = "line.json", .value = "/metrics/RMSE"};
  row.reference = {.campaign = "wimmer2021", .file = "fig7_depth.csv", .column = "concentration"};
  row.has_reference = true;
  EXPECT_EQ(run_row(row, places_).verdict, "not computed");
  put("desk/line.json", {{"status", "pending"}, {"metrics", nullptr}});
  EXPECT_EQ(run_row(row, places_).verdict, "pending");
  EXPECT_EQ(run_row(row, places_).failure, "");
}

TEST_F(Results, TheReportHoldsEveryRowAndEveryFailure) {
  ComparisonTable table;
  table.rows.push_back(width_row());
  table.rows.push_back(error_row());
  put("desk/track.json", {{"width_m", 120e-6}});
  const auto results = run_table(table, places_);
  const auto document = report(results, "desk");
  EXPECT_EQ(document["rows"].size(), 2u);
  EXPECT_EQ(document["failures"].size(), 1u);
  EXPECT_EQ(document["summary"]["agrees"], 1);
  EXPECT_EQ(document["summary"]["not computed"], 1);
  for (const char* key : {"name", "title", "kind", "rule", "S", "D", "E", "u_num", "u_input", "u_D",
                          "u_val", "unit", "verdict", "declared", "reason", "figure", "source"}) {
    EXPECT_TRUE(document["rows"][0].contains(key)) << key;
  }
  EXPECT_TRUE(document["rows"][0]["u_num"].is_null());
  EXPECT_NE(text_table(results).find("not as declared"), std::string::npos);
}

TEST_F(Results, BiasAndScatterNeedTwoRowsOfAQuantity) {
  ComparisonTable table;
  table.rows.push_back(width_row());
  put("desk/track.json", {{"width_m", 127.7e-6 * 1.1}, {"b", 178e-6 * 1.1}});
  EXPECT_TRUE(statistics(run_table(table, places_)).empty());
  Row other = width_row();
  other.simulated.value = "/b";
  other.reference.where = {"power = 150", "speed = 300", "powder = 0"};
  table.rows.push_back(other);
  const auto found = statistics(run_table(table, places_));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0]["quantity"], "all");
  EXPECT_EQ(found[1]["quantity"], "width");
  EXPECT_EQ(found[1]["points"], 2);
  EXPECT_TRUE(found[1]["scatter_is_noise"]);
}

TEST_F(Results, BiasAndScatterOfAllRowsTakeQuantitiesTogether) {
  ComparisonTable table;
  table.rows.push_back(width_row());
  put("desk/track.json", {{"width_m", 127.7e-6 * 1.1}, {"depth_m", 58.8e-6 * 0.9}});
  Row depth = width_row();
  depth.name = depth.quantity = depth.reference.column = "depth";
  depth.simulated.value = "/depth_m";
  table.rows.push_back(depth);
  const auto found = statistics(run_table(table, places_));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0]["quantity"], "all");
  // RMS of 6.6 and 30 %, the measurements' own.
  EXPECT_NEAR(found[0]["measured_scatter"].get<double>(), std::sqrt((0.066 * 0.066 + 0.09) / 2),
              1e-12);
}

TEST_F(Results, ATrendMayFollowMeasuredNumbers) {
  Row row = trend_row();
  row.simulated.files = {"a.json", "b.json"};
  row.reference = {.campaign = "ambench2022_03", .file = "tracks.csv", .column = "depth"};
  row.reference.where = {"case = 0", "case = 3.1"};  // 139.7, 166.1 um
  put("desk/a.json", {{"l", 100}, {"u", 3}});
  put("desk/b.json", {{"l", 120}, {"u", 3}});
  const auto found = run_row(row, places_);
  EXPECT_EQ(found.verdict, "agrees");
  EXPECT_EQ(found.numbers.details["reference"], json({139.7, 166.1}));
  row.reference.where = {"case = 3.1", "case = 0"};
  EXPECT_NE(run_row(row, places_).failure.find("does not rise from 166.1 to 139.7"),
            std::string::npos);
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

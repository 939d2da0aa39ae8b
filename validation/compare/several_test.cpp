// SPDX-License-Identifier: GPL-3.0-or-later
// What takes several numbers or rows: trends, curves, groups, statistics, the report. Every result
// in this file is synthetic: made up to exercise the runner.
#include <cmath>

#include "validation/compare/synthetic_results.hpp"

namespace meltproof::validation {
namespace {

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

}  // namespace
}  // namespace meltproof::validation

// SPDX-License-Identifier: GPL-3.0-or-later
// Every summary in this file is synthetic: made up, of no recording.
#include "validation/compare/recordings.hpp"

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "validation/compare/runner.hpp"

namespace meltproof::validation {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Recordings : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / "synthetic_recordings";
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "campaign");
  }
  fs::path put(const std::string& name, const json& summary) const {
    std::ofstream(folder_ / "campaign" / name) << summary;
    return folder_ / "campaign" / name;
  }
  /// A corrected length with 3 um of scatter and 4 um of systematic uncertainty.
  json summary(double length) const {
    return {{"synthetic", "made up for a test"},
            {"length_um", {{"mean", length + 9}, {"u_mean", 3.5}}},
            {"budget",
             {{"length_um", {{"value", length}, {"u", 5}}},
              {"inputs",
               {{{"input", "frames"}, {"type", "A"}, {"u_length_um", 3}},
                {{"input", "point spread"}, {"type", "B"}, {"u_length_um", 4}}}}}}};
  }
  fs::path folder_;
};

TEST_F(Recordings, OneTrackHasItsOwnScatterAndItsBudget) {
  const auto found = recorded_quantity({put("a.json", summary(300))}, "length");
  EXPECT_EQ(found.datum.value, 300);
  EXPECT_NEAR(*found.datum.uncertainty, 5, 1e-12);
  EXPECT_TRUE(found.synthetic);
}

TEST_F(Recordings, SeveralTracksScatterButShareWhatIsSystematic) {
  const auto found = recorded_quantity(
      {put("a.json", summary(290)), put("b.json", summary(300)), put("c.json", summary(310))},
      "length");
  EXPECT_NEAR(*found.datum.value, 300, 1e-12);
  EXPECT_NEAR(found.scatter, 10 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(found.systematic, 4, 1e-12);  // not 4 / sqrt(3)
  EXPECT_NEAR(*found.datum.uncertainty, std::hypot(10 / std::sqrt(3.0), 4), 1e-12);
}

TEST_F(Recordings, WithoutABudgetTheFramesCount) {
  const json plain = {
      {"length_um", {{"mean", 250}, {"u_mean", 5}, {"u_parts", {{"scatter between frames", 3}}}}}};
  const auto found = recorded_quantity({put("a.json", plain)}, "length");
  EXPECT_EQ(found.datum.value, 250);
  EXPECT_NEAR(found.scatter, 3, 1e-12);
  EXPECT_NEAR(found.systematic, 4, 1e-12);
  EXPECT_FALSE(found.synthetic);
}

TEST_F(Recordings, WhatIsNoMeasuredLengthIsRefused) {
  const auto pixels = put("px.json", {{"length_px", {{"mean", 20}}}});
  EXPECT_THROW(recorded_quantity({pixels}, "length"), InputError);
  EXPECT_THROW(recorded_quantity({folder_ / "absent.json"}, "length"), InputError);
  EXPECT_THROW(recorded_quantity({}, "length"), InputError);
  json damaged = summary(300);
  damaged["budget"]["inputs"][0].erase("u_length_um");
  EXPECT_THROW(recorded_quantity({put("damaged.json", damaged)}, "length"), InputError);
}

TEST_F(Recordings, ARowIsComparedWithThemAndSaysThatTheyAreSynthetic) {
  Row row;
  row.name = "filmed";
  row.kind = "validation";
  row.quantity = "length";
  row.unit = "um";
  row.metric = "difference";
  row.rule = "within_uncertainty";
  row.verdict = "agrees";
  row.simulated = {.file = "s.json", .value = "/l", .unit = "um"};
  row.reference = {.campaign = "campaign", .column = "length", .recordings = {"a.json"}};
  row.has_reference = true;
  put("a.json", summary(300));
  put("s.json", {{"l", 306}});
  const Places places{folder_ / "campaign", folder_ / "none.json", folder_};
  const auto found = run_row(row, places);
  EXPECT_EQ(found.verdict, "agrees");
  EXPECT_NEAR(*found.numbers.u_data, 5, 1e-12);
  EXPECT_NEAR(found.numbers.details["u_D_parts"]["systematic"].get<double>(), 4, 1e-12);
  EXPECT_EQ(found.source, "SYNTHETIC: 1 recording of campaign: length");
}

}  // namespace
}  // namespace meltproof::validation

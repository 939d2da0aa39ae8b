// SPDX-License-Identifier: GPL-3.0-or-later
// A folder of synthetic results, and rows that read them: for the tests of the runner.
#pragma once

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "validation/compare/metric.hpp"
#include "validation/compare/rule.hpp"
#include "validation/compare/runner.hpp"

namespace meltproof::validation {

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

}  // namespace meltproof::validation

// SPDX-License-Identifier: GPL-3.0-or-later
// Every result in this file is synthetic: made up to exercise the summary.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "validation/studies/summary.hpp"

namespace meltproof::validation {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Studies : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / "synthetic_studies";
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    for (const char* name : {"coarse", "base", "fine", "cure", "none"}) {
      studies_.runs.push_back({.name = name, .title = name, .track = "track_0wt"});
    }
    studies_.profile = "desk";
    studies_.series.push_back({.name = "resolution",
                               .title = "-",
                               .kind = "resolution",
                               .base = "base",
                               .runs = {"coarse", "base", "fine"},
                               .about = "-"});
    studies_.series.push_back({.name = "cure",
                               .title = "-",
                               .kind = "numerical",
                               .base = "base",
                               .runs = {"none", "base", "cure"},
                               .about = "-"});
  }
  void put(const std::string& name, double spacing, double size, double clumped = 0) const {
    std::ofstream(folder_ / (name + ".json"))
        << json{{"name", name},     {"spacing_um", spacing}, {"length_um", 3 * size},
                {"width_um", size}, {"depth_um", size},      {"clumped_fraction", clumped}};
  }
  fs::path folder_;
  StudyDeclaration studies_;
};

TEST_F(Studies, UncertaintyIsThatOfSpacingAndOfTheChoicesThatDoNotClump) {
  const auto f = [](double h) { return 100 + 0.02 * h * h; };
  put("coarse", 14, f(14));
  put("base", 10, f(10));
  put("fine", 7, f(7));
  put("cure", 10, f(10) + 4);
  put("none", 10, f(10) + 90, 0.5);
  const auto summary = summarise(studies_, folder_);
  const auto& parts = summary["quantities"]["width"]["parts"];
  EXPECT_NEAR(parts["resolution"].get<double>(), 0.5 * 1.25 * 2 / 102, 1e-9);
  EXPECT_NEAR(parts["cure"].get<double>(), 4 / std::sqrt(12.0) / 102, 1e-9);
  EXPECT_NEAR(summary["quantities"]["width"]["relative_u"].get<double>(),
              std::hypot(1.25, 4 / std::sqrt(12.0)) / 102, 1e-9);
  EXPECT_EQ(summary["series"][1]["quantities"]["width"]["left_out"], json::array({"none"}));
  EXPECT_NEAR(summary["series"][0]["quantities"]["length"]["order"].get<double>(), 2, 1e-6);
}

TEST_F(Studies, WhatIsNotThereYetIsNamedAndDoesNotCount) {
  put("base", 10, 100);
  const auto summary = summarise(studies_, folder_);
  EXPECT_TRUE(summary["quantities"]["width"]["relative_u"].is_null());
  EXPECT_EQ(summary["series"][0]["missing"], json::array({"coarse", "fine"}));
  EXPECT_EQ(summary["runs"].size(), 1u);
}

TEST_F(Studies, ADamagedResultIsRefused) {
  std::ofstream(folder_ / "base.json") << "{\"name\"";
  EXPECT_THROW(summarise(studies_, folder_), InputError);
}

TEST(StudyDeclarationShipped, IsValid) {
  StudyDeclaration studies;
  study_input(studies).read("pipelines/studies.toml");
  EXPECT_NO_THROW(check(studies, "pipelines/studies.toml"));
  for (const auto& run : studies.runs) {
    EXPECT_TRUE(fs::is_regular_file("solver/cases/" + run.track + ".toml")) << run.name;
  }
}

TEST(StudyDeclarationShipped, ASeriesWithoutItsRunsIsRefused) {
  StudyDeclaration studies;
  studies.runs.push_back({.name = "a", .title = "-", .track = "-"});
  studies.series.push_back({.name = "s",
                            .title = "-",
                            .kind = "numerical",
                            .base = "a",
                            .runs = {"a", "b"},
                            .about = ""});
  EXPECT_THROW(check(studies, "x"), InputError);
  studies.series[0].runs = {"a"};
  EXPECT_NO_THROW(check(studies, "x"));
  studies.series[0].kind = "resolution";
  EXPECT_THROW(check(studies, "x"), InputError);
}

}  // namespace
}  // namespace meltproof::validation

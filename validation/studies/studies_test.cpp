// SPDX-License-Identifier: GPL-3.0-or-later
// Every result in this file is synthetic: made up to exercise the summary.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "validation/studies/inputs.hpp"
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

TEST_F(Studies, AResultOfOtherSettingsThanDeclaredDoesNotCount) {
  put("base", 10, 100);
  ASSERT_EQ(summarise(studies_, folder_)["runs"].size(), 1u);
  std::ofstream(folder_ / "base.json") << json{
      {"name", "base"}, {"settings", {"spacing=9 um"}}, {"spacing_um", 9}, {"clumped_fraction", 0}};
  const auto summary = summarise(studies_, folder_);
  EXPECT_TRUE(summary["runs"].empty());
  EXPECT_EQ(summary["series"][0]["missing"], json::array({"coarse", "base", "fine"}));
}

TEST_F(Studies, WhatIsNotThereYetIsNamedAndDoesNotCount) {
  put("base", 10, 100);
  const auto summary = summarise(studies_, folder_);
  EXPECT_TRUE(summary["quantities"]["width"]["relative_u"].is_null());
  EXPECT_EQ(summary["series"][0]["missing"], json::array({"coarse", "fine"}));
  ASSERT_EQ(summary["runs"].size(), 1u);
  EXPECT_EQ(summary["runs"][0]["title"], "base");  // of the declaration; the result has none
}

/// The absorptivity of the base as an input, 0.36 and 0.44 around 0.4.
StudySeries absorptivity() {
  return {.name = "absorptivity",
          .title = "-",
          .kind = "input",
          .base = "base",
          .runs = {"base", "low", "high"},
          .about = "-",
          .key = "laser.absorptivity",
          .value = "0.4",
          .uncertainty = "0.05",
          .reason = "synthetic"};
}

TEST_F(Studies, AnInputMovesTheResultByItsSensitivity) {
  studies_.runs.push_back({.name = "low", .set = {"spacing=10 um", "laser.absorptivity=0.36"}});
  studies_.runs.push_back({.name = "high", .set = {"laser.absorptivity=0.44"}});
  studies_.runs.push_back({.name = "liquid", .set = {"materials.diffusivity_law=liquid"}});
  studies_.series = {absorptivity(),
                     {.name = "law",
                      .title = "-",
                      .kind = "input",
                      .base = "base",
                      .runs = {"base", "liquid"},
                      .about = "-",
                      .key = "materials.diffusivity_law",
                      .reason = "synthetic"}};
  check(studies_, "x");
  put("base", 10, 100);
  put("low", 10, 92);
  put("high", 10, 108);
  const auto partly = summarise(studies_, folder_);
  EXPECT_EQ(partly["inputs"]["depth"]["missing"], json::array({"law"}));
  put("liquid", 10, 103);
  const auto summary = summarise(studies_, folder_);
  const auto& of_depth = summary["inputs"]["depth"];
  // 8 % for 10 %: a sensitivity of 0.8; u of the input is 12.5 %, so 10 % of the depth.
  EXPECT_NEAR(of_depth["sensitivities"]["absorptivity"].get<double>(), 0.8, 1e-9);
  EXPECT_NEAR(of_depth["parts"]["absorptivity"].get<double>(), 0.1, 1e-9);
  EXPECT_NEAR(of_depth["parts"]["law"].get<double>(), 0.03 / std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(of_depth["relative_u"].get<double>(), std::hypot(0.1, 0.03 / std::sqrt(3.0)), 1e-9);
  EXPECT_TRUE(of_depth["missing"].empty());
  EXPECT_TRUE(summary["quantities"]["depth"]["relative_u"].is_null());
  EXPECT_EQ(summary["series"][0]["quantities"]["depth"]["changes"][0]["setting"], "0.36");
}

TEST_F(Studies, ARunOfAnInputThatClumpsIsLeftOutAndNamed) {
  studies_.runs.push_back({.name = "low", .set = {"laser.absorptivity=0.36"}});
  studies_.runs.push_back({.name = "high", .set = {"laser.absorptivity=0.44"}});
  studies_.series = {absorptivity()};
  put("base", 10, 100);
  put("low", 10, 92);
  put("high", 10, 190, 0.2);
  const auto summary = summarise(studies_, folder_);
  const auto& effect = summary["series"][0]["quantities"]["width"];
  EXPECT_EQ(effect["left_out"], json::array({"high"}));
  EXPECT_TRUE(effect["one_sided"].get<bool>());
  EXPECT_NEAR(effect["relative_sensitivity"].get<double>(), 0.8, 1e-9);
  put("low", 10, 92, 0.2);
  EXPECT_EQ(summarise(studies_, folder_)["inputs"]["width"]["missing"],
            json::array({"absorptivity"}));
}

TEST_F(Studies, AnInputWithUnitsAndSharesIsUnderstood) {
  StudySeries radius = absorptivity();
  radius.key = "laser.radius";
  radius.value = "40 um";
  radius.uncertainty = "2e-6 m";
  EXPECT_NEAR(input_facts(radius)["relative_uncertainty"].get<double>(), 0.05, 1e-12);
  radius.uncertainty = "5 %";
  EXPECT_NEAR(input_facts(radius)["relative_uncertainty"].get<double>(), 0.05, 1e-12);
  radius.uncertainty = "2 K";
  EXPECT_THROW(input_facts(radius), InputError);
}

TEST_F(Studies, AFaultyInputIsRefused) {
  studies_.runs.push_back({.name = "low", .set = {"laser.absorptivity=0.36"}});
  studies_.runs.push_back({.name = "high", .set = {"laser.absorptivity=0.44"}});
  const auto refused = [&](auto change) {
    studies_.series = {absorptivity()};
    change(studies_.series[0]);
    EXPECT_THROW(check(studies_, "x"), InputError);
  };
  studies_.series = {absorptivity()};
  EXPECT_NO_THROW(check(studies_, "x"));
  refused([](StudySeries& s) { s.reason.clear(); });
  refused([](StudySeries& s) { s.uncertainty.clear(); });
  refused([](StudySeries& s) { s.key = "laser.power"; });
  refused([](StudySeries& s) { s.runs = {"base"}; });
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

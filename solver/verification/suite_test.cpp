// SPDX-License-Identifier: GPL-3.0-or-later
// Long cases: their committed results stand in for them, and say when they are out of date.
#include "solver/verification/suite.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "base/atomic_file.hpp"
#include "base/error.hpp"

namespace meltproof::solver {
namespace {

namespace fs = std::filesystem;

const std::string text = R"(
kind = "stefan"
title = "t"
reference = "r"
quantity = "q"
asked = 0.01
spacings = ["4 um", "5 um"]
long = true
)";

fs::path fresh_case(const std::string& name) {
  const fs::path folder = fs::temp_directory_path() / ("meltproof_suite_" + name);
  fs::remove_all(folder);
  write_file(folder / "slow" / "case.toml", text);
  return folder;
}

nlohmann::json row(double error) {
  return {{"name", "slow"}, {"error", error}, {"broken", nlohmann::json::array()}, {"order", 1}};
}

}  // namespace

TEST(Suite, FindsCasesByFolderAndNamesThemAfterIt) {
  const fs::path folder = fresh_case("find");
  const auto files = find_cases({folder.string()});
  ASSERT_EQ(files.size(), 1U);
  const VerificationCase c = read_case(files[0]);
  EXPECT_EQ(c.name, "slow");
  EXPECT_TRUE(c.long_running);
  EXPECT_THROW(find_cases({(folder / "nowhere").string()}), InputError);
}

TEST(Suite, ALongCaseWithoutAResultHasNone) {
  const fs::path folder = fresh_case("none");
  const auto file = folder / "slow" / "case.toml";
  EXPECT_TRUE(CommittedResults{folder / "results"}.read(read_case(file), file).is_null());
}

TEST(Suite, ACommittedResultSaysWhereItIsFromAndIsJudgedByWhatIsAskedNow) {
  const fs::path folder = fresh_case("kept");
  const auto file = folder / "slow" / "case.toml";
  const CommittedResults committed{folder / "results"};
  committed.write(row(0.005), "spacing [um]\n", file);
  const auto kept = committed.read(read_case(file), file);
  EXPECT_TRUE(kept["pass"].get<bool>());
  EXPECT_FALSE(kept["stale"].get<bool>());
  EXPECT_EQ(kept["from"].get<std::string>().rfind("committed result of revision ", 0), 0U);
  EXPECT_TRUE(fs::exists(kept["profile_csv"].get<std::string>()));

  std::string stricter = text;
  stricter.replace(stricter.find("0.01"), 4, "1e-3");
  write_file(file, stricter);
  const auto judged = committed.read(read_case(file), file);
  EXPECT_TRUE(judged["stale"].get<bool>()) << "the case has changed since";
  EXPECT_FALSE(judged["pass"].get<bool>());
}

TEST(Suite, AResultOfOtherCodeIsStaleAndABrokenConditionFails) {
  const fs::path folder = fresh_case("stale");
  const auto file = folder / "slow" / "case.toml";
  const CommittedResults committed{folder / "results"};
  auto broken = row(0.001);
  broken["broken"].push_back("a particle was lost");
  committed.write(broken, "spacing [um]\n", file);
  EXPECT_FALSE(committed.read(read_case(file), file)["pass"].get<bool>());

  auto record = nlohmann::json::parse(read_file(folder / "results" / "slow.json"));
  record["revision"] = "000000000000";
  write_file(folder / "results" / "slow.json", record.dump());
  EXPECT_TRUE(committed.read(read_case(file), file)["stale"].get<bool>());
  write_file(folder / "results" / "slow.json", "{");
  EXPECT_THROW(committed.read(read_case(file), file), InputError);
}

}  // namespace meltproof::solver

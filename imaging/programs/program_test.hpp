// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of whole programs: run as a user runs them, in a folder of their own.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "base/atomic_file.hpp"

namespace meltproof::imaging {

class ProgramTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              fmt::format("meltproof-{}-{}", test->name(), ::getpid());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Runs a command; what it says is in text_. @returns its exit status.
  int run(const std::string& command) {
    const std::string log = (folder_ / "log").string();
    const int status = std::system(fmt::format("{} > {} 2>&1", command, log).c_str());
    text_ = read_file(log);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::filesystem::path file(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  std::filesystem::path output() const { return folder_ / "out"; }
  static nlohmann::json json_of(const std::filesystem::path& path) {
    return nlohmann::json::parse(read_file(path));
  }
  /// Status 2, one line that holds `said`, and no output at all.
  void expect_refusal(const std::string& command, const std::string& said) {
    std::filesystem::remove_all(output());
    EXPECT_EQ(run(command), 2) << text_;
    EXPECT_NE(text_.find(said), std::string::npos) << text_;
    EXPECT_EQ(text_.find('\n'), text_.size() - 1) << text_;
    EXPECT_FALSE(std::filesystem::exists(output())) << text_;
  }

  std::filesystem::path folder_;
  std::string text_;
};

/// The column of a table with commas whose head begins with `name`.
inline std::vector<double> column(const std::filesystem::path& table, const std::string& name) {
  std::istringstream lines(read_file(table));
  std::string line, cell;
  std::getline(lines, line);
  std::istringstream head(line);
  std::size_t wanted = 0;
  while (std::getline(head, cell, ',') && !cell.starts_with(name)) ++wanted;
  std::vector<double> values;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    for (std::size_t i = 0; i <= wanted; ++i) std::getline(cells, cell, ',');
    values.push_back(cell.empty() ? 0 : std::stod(cell));
  }
  return values;
}

}  // namespace meltproof::imaging

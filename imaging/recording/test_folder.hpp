// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of readers: a folder of its own for each test, and the sentence of a refusal.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/error.hpp"

namespace meltproof::imaging {

/// A folder that is removed at the end of the test.
class TestFolder {
 public:
  TestFolder()
      : path_(std::filesystem::temp_directory_path() /
              fmt::format("meltproof-{}-{}",
                          testing::UnitTest::GetInstance()->current_test_info()->name(),
                          ::getpid())) {
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  /// A file with these bytes.
  std::filesystem::path file(const std::string& name, const std::string& bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

/// What `open` is refused with; empty if it is not refused.
template <class Open>
std::string refusal_of(const Open& open) {
  try {
    open();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// Whether `text` holds `part`.
inline testing::AssertionResult says(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "\"" << part << "\" is not in: " << text;
}

}  // namespace meltproof::imaging

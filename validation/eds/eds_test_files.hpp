// SPDX-License-Identifier: GPL-3.0-or-later
// Files for the tests of the readers. All are synthetic unless a test names one of the vendors'.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace meltproof::validation {

/// Writes a text under a name of its own for this test.
inline std::filesystem::path synthetic_file(const std::string& name, const std::string& content) {
  const auto path = std::filesystem::path(testing::TempDir()) / ("synthetic_" + name);
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

/// The sentence that `read` is refused with; empty if it is not.
inline std::string sentence(const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& problem) {
    return problem.what();
  }
  return "";
}

/// Expects a refusal that holds `words`.
#define EXPECT_REFUSED(action, words)                                             \
  do {                                                                            \
    const std::string said = sentence([&] { action; });                           \
    EXPECT_NE(said.find(words), std::string::npos) << "said: \"" << said << "\""; \
  } while (false)

/// A file that a vendor's program wrote, which stands beside the checkout and is not part of it.
inline std::filesystem::path vendor_file(const std::string& name) {
  return std::filesystem::path("../shared/samples") / name;
}

}  // namespace meltproof::validation

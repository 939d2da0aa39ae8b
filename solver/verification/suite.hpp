// SPDX-License-Identifier: GPL-3.0-or-later
// The suite: which cases there are, which of them run now, and the committed results of the others.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "solver/verification/case.hpp"

namespace meltproof::solver {

/// The case.toml of every named folder, or of the folders in it, sorted by path.
/// @throws InputError if a folder is missing or holds no case.
std::vector<std::filesystem::path> find_cases(const std::vector<std::string>& folders);

/// Reads one case; its name is its folder's.
VerificationCase read_case(const std::filesystem::path& file);

/// A long case's result is committed as results/<case>.json, with its profile in <case>.csv beside.
struct CommittedResults {
  std::filesystem::path folder;

  /// Writes row and profile with the revision of this program and the checksum of the case. Nothing
  /// in it depends on the machine or the hour.
  void write(const nlohmann::json& row, const std::string& profile,
             const std::filesystem::path& case_file) const;

  /// The committed row: `from` says of which revision, `stale` whether code or case have changed
  /// since. `pass` is judged anew with what `c` asks now; a null row says that there is none.
  nlohmann::json read(const VerificationCase& c, const std::filesystem::path& case_file) const;
};

}  // namespace meltproof::solver

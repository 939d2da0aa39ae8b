// SPDX-License-Identifier: GPL-3.0-or-later
// Where an artifact comes from: enough to make it again.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace meltproof {

/// SHA-256 of a file's bytes as 64 hexadecimal digits. @throws InputError if it cannot be read.
std::string sha256_file(const std::filesystem::path& path);
/// SHA-256 of a text as 64 hexadecimal digits.
std::string sha256_text(const std::string& text);

/// The revision of the code that this program was built from: the last commit that touched a folder
/// with code, with "-dirty" appended when those folders held uncommitted changes.
std::string code_revision();
/// The suite's version, for example "0.1.0".
std::string suite_version();

/// One input file as an artifact records it.
struct InputRecord {
  std::string path;    ///< as the user named it
  std::string sha256;  ///< of its bytes when it was read
};

/// What `/provenance` of an artifact and the `provenance` object of a JSON result hold.
struct Provenance {
  std::string program;                           ///< "meltproof-solve"
  std::string command;                           ///< the command line as typed
  std::string resolved_input;                    ///< TOML, every default filled in
  std::vector<InputRecord> inputs;               ///< every file that was read
  std::map<std::string, std::string> libraries;  ///< name to version
  long long seed = 0;                            ///< of the random numbers; 0 if none were drawn
  int ranks = 1;
  int threads = 1;
  double wall_time = 0;  ///< s; set it to elapsed() before the artifact is written
  std::chrono::steady_clock::time_point started;

  /// Adds a file with its checksum.
  void add_input(const std::filesystem::path& path);
  /// Seconds since begin_provenance().
  double elapsed() const;
  nlohmann::json json() const;
};

/// A provenance with program, command, library versions of the base and the clock started.
Provenance begin_provenance(int argc, const char* const* argv);

}  // namespace meltproof

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/verification/suite.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/provenance.hpp"

namespace meltproof::solver {

namespace fs = std::filesystem;

std::vector<fs::path> find_cases(const std::vector<std::string>& folders) {
  std::vector<fs::path> files;
  for (const fs::path folder : folders) {
    if (fs::exists(folder / "case.toml")) {
      files.push_back(folder / "case.toml");
      continue;
    }
    if (!fs::is_directory(folder)) {
      throw InputError(
          fmt::format("{} is no folder: expected one with a case.toml, or one of such folders",
                      folder.string()));
    }
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (fs::exists(entry.path() / "case.toml")) {
        files.push_back(entry.path() / "case.toml");
      }
    }
  }
  std::sort(files.begin(), files.end());
  if (files.empty()) {
    throw InputError(fmt::format("{}: no folder in it holds a case.toml", folders.front()));
  }
  return files;
}

VerificationCase read_case(const fs::path& file) {
  VerificationCase c;
  declare(c).read(file);
  c.name = fs::absolute(file).parent_path().filename().string();
  return c;
}

void CommittedResults::write(const nlohmann::json& row, const std::string& profile,
                             const fs::path& case_file) const {
  const std::string name = row.at("name");
  nlohmann::json record = row;
  record["revision"] = code_revision();
  record["case_sha256"] = sha256_file(case_file);
  write_file(folder / (name + ".csv"), profile);
  write_file(folder / (name + ".json"), record.dump(2) + "\n");
}

nlohmann::json CommittedResults::read(const VerificationCase& c, const fs::path& case_file) const {
  const fs::path place = folder / (c.name + ".json");
  if (!fs::exists(place)) {
    return nullptr;
  }
  try {
    nlohmann::json row = nlohmann::json::parse(read_file(place));
    const std::string revision = row.at("revision");
    row["from"] = fmt::format("committed result of revision {}", revision);
    row["stale"] = revision != code_revision() || row.at("case_sha256") != sha256_file(case_file);
    row["asked"] = c.asked;
    row["pass"] = row.at("error").get<double>() <= c.asked && row.at("broken").empty();
    row["profile_csv"] = (folder / (c.name + ".csv")).string();
    return row;
  } catch (const nlohmann::json::exception& problem) {
    throw InputError(fmt::format("{} is no result of a case ({}); make it again with --long",
                                 place.string(), problem.what()));
  }
}

}  // namespace meltproof::solver

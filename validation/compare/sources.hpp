// SPDX-License-Identifier: GPL-3.0-or-later
// Where the numbers of a row are fetched from.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "validation/compare/table.hpp"
#include "validation/dataset.hpp"

namespace meltproof::validation {

/// The folders of one comparison.
struct Places {
  std::filesystem::path results;       ///< of the profile: reports/work/<profile>
  std::filesystem::path verification;  ///< verification.json
  std::filesystem::path experiments;   ///< data/experiments
  std::filesystem::path studies = {};  ///< of meltproof-studies; empty or missing: no study yet
};

/// @throws InputError naming the file if it is missing or no JSON.
nlohmann::json read_json(const std::filesystem::path& path);

/// The number at a JSON pointer. @throws InputError naming file and pointer if it is missing or no
/// finite number.
double number_at(const nlohmann::json& document, const std::string& pointer,
                 const std::filesystem::path& path);

/// A simulated number in the row's unit.
struct SimulatedNumber {
  double value = 0;
  std::optional<double> uncertainty;  ///< u_num: own scatter, spacing, numerical choices
  /// What u_num is made of, in the row's unit: "scatter" and either "spacing" or "studies".
  nlohmann::json parts = nlohmann::json::object();
  bool studied = true;  ///< false: the row names a study whose results are not there
};
SimulatedNumber simulated_number(const Row& row, const std::string& file, const Places& places);

/// A case of verification.json: its error and what was asked of it.
struct VerificationNumber {
  double error = 0, asked = 0;
  std::vector<std::string> broken = {};  ///< other conditions of the case that its run did not hold
};
VerificationNumber verification_number(const Row& row, const Places& places);

/// The files of results that a row reads.
std::vector<std::filesystem::path> simulated_files(const Row& row, const Places& places);

/// summary.json of each recording that the row's reference names.
std::vector<std::filesystem::path> recordings(const Row& row, const Places& places);

/// The row's measured number, in the row's unit; without value if the slot is empty.
/// @throws InputError as read_campaign() or recorded_quantity().
Datum reference_number(const Row& row, const Places& places);

/// The campaign and file of the row's reference.
Campaign reference_campaign(const Row& row, const Places& places);

}  // namespace meltproof::validation

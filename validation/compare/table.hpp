// SPDX-License-Identifier: GPL-3.0-or-later
// The comparison table: one row is one comparison, stated before its data are seen.
#pragma once

#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/input.hpp"

namespace meltproof::validation {

/// Where the simulated number of a row stands. Files are named from the folder of the profile.
struct SimulatedSource {
  std::string verification_case = {};   ///< name of a case in verification.json, instead of a file
  std::string file = {};                ///< JSON
  std::vector<std::string> files = {};  ///< JSON, in the order of the settings of a trend
  std::string value = {};               ///< JSON pointer to the number, "/pool_length_um"
  std::string uncertainty = {};         ///< JSON pointer to its standard uncertainty; empty: none
  std::string over = {};                ///< JSON pointer to a number that divides the first
  std::string spacing = {};             ///< JSON pointer to the particle spacing; empty: none
  /// Quantity of the studies whose shares enter u_num and u_input; empty: none.
  std::string study = {};
  /// "name = 5 %": inputs of the studies whose relative uncertainty is another one in this row.
  std::vector<std::string> inputs = {};
  std::string unit = "1";  ///< of value, uncertainty and spacing
};

/// Where the measured number of a row stands.
struct ReferenceSource {
  std::string campaign = {};  ///< folder in data/experiments
  std::string file = {}, column = {};
  /// Conditions that pick one row of the file; of a trend one for each setting. Empty: all rows.
  std::vector<std::string> where = {};
  /// Instead of file: summary.json of each recorded track, in the campaign's folder.
  std::vector<std::string> recordings = {};
  double relative_uncertainty = 0;  ///< standard, added to what the campaign declares
};

struct Row {
  std::string name, title;
  /// Not empty: the row stands for one row per word, which replaces {} in name, title, case, file.
  std::vector<std::string> for_each = {};
  bool every_case = false;  ///< the row stands for one row per verification case
  std::string kind;         ///< verification, benchmark, validation, trend
  std::string quantity;     ///< length, width, depth, ...: rows of one quantity share a statistic
  std::string unit = "1";   ///< of S, D, E and u
  std::string window;       ///< what was averaged, in words
  std::string metric;       ///< what is computed, see compare/metric.hpp
  std::string rule;         ///< when it agrees, see compare/rule.hpp
  std::string rule_reason;  ///< why this rule
  double limit = 0;         ///< of rules "at_most" and "at_least", in `unit`
  double coverage = 2;      ///< k of the rules with an uncertainty
  std::optional<double> input_uncertainty;  ///< u_input in `unit`; absent: from the studies
  std::string figure;
  std::string verdict;    ///< declared: agrees, differs, pending
  std::string reason;     ///< of the declared verdict
  std::string waits_for;  ///< of a pending row: reference or simulation
  SimulatedSource simulated;
  ReferenceSource reference;
  bool has_reference = false;
};

/// What is known to be otherwise in one profile, because its spacing is another one.
struct Exception {
  std::string profile;
  std::string track = {};              ///< rows that read a file of this folder
  std::vector<std::string> rows = {};  ///< rows by name
  std::string verdict;  ///< instead of the rows' own; "left out": not made in this profile
  std::string reason;
  /// Whether it is about a row that stands for itself.
  bool is_about(const Row& row) const;
};

struct ComparisonTable {
  std::deque<Row> rows;
  std::deque<Exception> exceptions;
};

/// The declaration of validation/comparisons.toml bound to `table`, which must outlive it.
Input comparison_input(ComparisonTable& table);

/// @throws InputError as Input::read, and for: two rows of one name, a pending row that does not
/// say
///         what it waits for or another one that does, a row without a simulated source, a metric
///         "difference", "curve" or "trend" without a reference.
void check(const ComparisonTable& table, const std::filesystem::path& path);

/// The rows with those that stand for several written out, in the order of the table; a row that
/// another one would write out too counts instead of it.
/// @param verification verification.json; without it a row for every_case stays as it is.
std::deque<Row> expand(const ComparisonTable& table, const nlohmann::json& verification);

}  // namespace meltproof::validation

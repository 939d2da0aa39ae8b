// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the comparison table.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "validation/compare/result.hpp"
#include "validation/compare/sources.hpp"
#include "validation/compare/table.hpp"

namespace meltproof::validation {

/// A row of the table with what came out.
struct RowResult {
  Row row;
  RowNumbers numbers;
  std::string verdict;  ///< agrees, differs, pending, or "not computed"
  std::string finding;  ///< what came out, in words
  std::string source;   ///< of the reference, in words
  std::string failure;  ///< why the runner fails on this row; empty if it does not
};

/// Computes one row and judges it. A row whose reference is empty, or that waits for a simulation
/// that is not there, is pending; one that lacks anything else is "not computed" and fails; one
/// whose verdict is not the declared one fails. Throws nothing for a row's own faults.
RowResult run_row(const Row& row, const Places& places);

/// All rows, those that stand for several written out, with the exceptions of a profile.
/// @throws InputError for an exception that is about no row.
std::vector<RowResult> run_table(const ComparisonTable& table, const Places& places,
                                 const std::string& profile = "");

/// Bias and scatter of ln(S/D) for each quantity with at least two rows that have both numbers, and
/// as "all" over every such row, whatever its quantity.
nlohmann::json statistics(const std::vector<RowResult>& results);

/// The whole result: {profile, rows, summary, statistics, failures}. Files are named without the
/// folders of `places`, so that equal results are equal bytes anywhere.
nlohmann::json report(const std::vector<RowResult>& results, const std::string& profile);

/// The rows as a table for a terminal.
std::string text_table(const std::vector<RowResult>& results);

}  // namespace meltproof::validation

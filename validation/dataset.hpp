// SPDX-License-Identifier: GPL-3.0-or-later
// Published measurements: a folder of data/experiments with dataset.toml and its CSV files.
#pragma once

#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/input.hpp"

namespace meltproof::validation {

/// One column of a CSV file, as dataset.toml declares it and as the file fills it.
struct DataColumn {
  std::string name;
  std::string unit;              ///< udunits2, as in the CSV header; "text" for labels
  std::string about;             ///< what the numbers are
  std::string uncertainty;       ///< name of the column that holds the uncertainty; empty: none
  std::string uncertainty_kind;  ///< "standard deviation", "standard uncertainty of the mean", ...
  std::optional<double> relative_uncertainty;  ///< standard uncertainty as a share of the value
  std::vector<std::string> cells;              ///< as written
  std::vector<double> numbers;                 ///< in `unit`; NaN where the cell is empty or a text

  bool is_text() const { return unit == "text"; }
};

/// One CSV file of a campaign.
struct DataFile {
  std::string name, sha256, about;
  std::string obtained;  ///< "measured", "digitised" or "pending"
  std::string source;    ///< publication, if the campaign has several
  std::deque<DataColumn> columns;
  std::filesystem::path path;

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().cells.size(); }
  /// @throws InputError naming file and column, and the columns that there are.
  const DataColumn& column(const std::string& wanted) const;
  /// The one row in which every condition "column = value" holds; numbers compare as numbers.
  /// @throws InputError if none or several rows match, or a condition is none.
  std::size_t row(const std::vector<std::string>& conditions) const;
};

/// A campaign: where the numbers come from, and the files.
struct Campaign {
  std::string title, doi, licence, about;
  std::vector<std::string> authors;
  std::deque<DataFile> files;
  std::filesystem::path folder;

  /// @throws InputError naming the campaign and the files that it has.
  const DataFile& file(const std::string& name) const;
  /// dataset.toml and every CSV file, for provenance.
  std::vector<std::filesystem::path> paths() const;
};

/// One measured number. Without `value` the slot is empty (pending).
struct Datum {
  std::optional<double> value;
  std::optional<double> uncertainty;  ///< standard uncertainty, in the same unit
  std::string unit;
};

/// The declaration of dataset.toml bound to `campaign`, which must outlive it.
Input campaign_input(Campaign& campaign);

/// Reads `folder`/dataset.toml and every file that it names.
/// @throws InputError with a sentence for: no dataset.toml, an unknown key, a missing CSV, bytes
/// that
///         are not those of the SHA-256, a missing or undeclared column, another unit in a column's
///         header, a row of another length, a cell that is no number, a value in a pending column.
Campaign read_campaign(const std::filesystem::path& folder);

/// The number in `column` and `row` with its uncertainty: that of the column's uncertainty column
/// and the relative one, added in quadrature.
Datum datum(const DataFile& file, const std::string& column, std::size_t row);

}  // namespace meltproof::validation

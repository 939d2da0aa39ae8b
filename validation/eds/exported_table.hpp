// SPDX-License-Identifier: GPL-3.0-or-later
// The table of numbers in a CSV export whose dialect and first lines depend on the vendor.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace meltproof::validation {

/// The rows of numbers and the header above them.
struct ExportedTable {
  std::vector<std::string> header;  ///< one per column; two header lines are joined by a blank
  /// NaN in a first column of labels, and for empty cells at the end of a row: not known.
  std::vector<std::vector<double>> rows;
  std::string preamble;        ///< the lines above the header, lower case
  std::size_t first_line = 0;  ///< of the rows, counted from 1
};

/// Finds separator (comma, semicolon, tab) and decimal sign by which most lines are rows of
/// numbers; the table is the first run of them. A first column may hold labels, separators at the
/// end of lines make no cell, UTF-16 is understood. Micro signs become "u", the Greek sigma
/// "sigma", the sign of an uncertainty "+/-".
/// @throws InputError if there is no such row, a row has other cells than the first, or is no
/// number.
ExportedTable read_exported_table(const std::filesystem::path& path);

/// ASCII letters in lower case.
std::string lower(std::string text);

}  // namespace meltproof::validation

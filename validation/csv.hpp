// SPDX-License-Identifier: GPL-3.0-or-later
// Tables as text: what the campaigns of data/experiments and the exports of EDS programs share.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meltproof::validation {

/// The text without blanks, tabs and a carriage return at its ends.
std::string trimmed(std::string_view text);

/// The lines of a text, without line ends (LF or CRLF) and without a byte-order mark before the
/// first.
std::vector<std::string> lines_of(const std::string& text);

/// The cells of one line, trimmed. A cell in double quotes may hold the separator and doubled
/// quotes.
std::vector<std::string> split_cells(const std::string& line, char separator);

/// A whole cell as a number; nothing if it is none. With `decimal_comma` the comma is the decimal
/// sign and a point is refused.
std::optional<double> number_of(const std::string& cell, bool decimal_comma = false);

/// A column header "length [um]".
struct ColumnHeader {
  std::string name;
  std::string unit;  ///< empty if the header has none
};
ColumnHeader parse_header(const std::string& cell);

}  // namespace meltproof::validation

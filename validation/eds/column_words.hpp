// SPDX-License-Identifier: GPL-3.0-or-later
// What the header of one column of an exported line scan says.
#pragma once

#include <optional>
#include <string>

namespace meltproof::validation {

/// What a column holds.
enum class Role {
  fraction,
  uncertainty,
  counts,
  background,
  total,
  alloy,
  alloy_uncertainty,
  other
};
/// Of what a fraction is one; `unknown` names a unit that is neither.
enum class Share { none, mass, atom, unknown };

struct ColumnWords {
  Role role = Role::other;
  Share share = Share::none;
  std::string element;      ///< symbol; empty if none
  std::string unit;         ///< in brackets, as written; empty if none
  double coverage = 1;      ///< an uncertainty is given as so many standard deviations
  bool relative = false;    ///< an uncertainty relative to the value
  bool normalised = false;  ///< a fraction that was normalised
};

/// Reads a header such as "Al Wt% Sigma" or "Al-K norm. [wt.%]".
ColumnWords read_column_header(const std::string& header);

/// wt% or at%, by the words of a text in lower case; `none` if it does not say.
Share share_named_in(const std::string& text);

/// Metres per unit of a position, by its header; nothing if it names none of nm, um, mm.
std::optional<double> length_unit_named_in(const std::string& header);

}  // namespace meltproof::validation

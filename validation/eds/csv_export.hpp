// SPDX-License-Identifier: GPL-3.0-or-later
// Line scans as text tables: what AZtec, Esprit, EDAX's programs and the slots of data/experiments
// have in common, and where they differ.
#pragma once

#include <filesystem>
#include <string_view>

#include "validation/eds/line_scan.hpp"

namespace meltproof::validation {

/// Text without zero bytes, or UTF-16 with its mark; asked last, since other formats are text too.
bool is_csv_export(std::string_view first_bytes);

/// Found by itself: separator (comma, semicolon, tab), decimal comma, lines before the table, one
/// or two header lines, UTF-16, a first column of labels. Position: a column "Distance" or
/// "Position" in nm, um or mm, or the way along columns x and y. Elements: "Al Wt%", "Al-K [wt.%]",
/// "AlK (wt%)", "Al", with wt% or at% in the header or in the lines above (wt% if both are there;
/// not normalised rather than normalised). Uncertainties: "sigma", "error", "+/-", of 1, 2 or 3
/// sigma, absolute or relative. Counts: "Al counts", "Al background counts".
/// @throws InputError as read_line_scan().
LineScan read_csv_export(const std::filesystem::path& path);

}  // namespace meltproof::validation

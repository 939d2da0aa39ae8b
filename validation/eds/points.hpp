// SPDX-License-Identifier: GPL-3.0-or-later
// Spectra with the vendor's composition as the points of a line.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "validation/eds/line_scan.hpp"

namespace meltproof::validation {

/// A CSV whose header is "file" and "position [um]".
bool is_point_list(std::string_view first_bytes);

/// A list of spectra (.spx), by their paths relative to the list, and where each was taken.
/// @throws InputError naming the line for what is missing, or a spectrum without a composition.
LineScan read_point_list(const std::filesystem::path& path);

/// The .spx of a folder in the order of the numbers in their names.
/// @throws InputError if there is none.
std::vector<std::filesystem::path> spectra_of_folder(const std::filesystem::path& folder);

/// The .spx of a folder in the order of the numbers in their names, `spacing` m apart.
LineScan read_point_folder(const std::filesystem::path& folder, double spacing);

/// One spectrum (.spx) alone: a line of one point, at 0.
LineScan read_single_point(const std::filesystem::path& path);

}  // namespace meltproof::validation

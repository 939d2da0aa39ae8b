// SPDX-License-Identifier: GPL-3.0-or-later
// Oxford Instruments' open exchange format (.h5oina): EDS line scans and maps.
#pragma once

#include <filesystem>
#include <string_view>
#include <variant>

#include "validation/eds/element_map.hpp"
#include "validation/eds/line_scan.hpp"

namespace meltproof::validation {

/// The signature of HDF5.
bool is_h5oina(std::string_view first_bytes);

/// The composition of the first slice with EDS data, by the public specification of the format
/// (versions 1 to 8): <slice>/EDS/Data/Composition in wt%, Composition Sigma if it is there, a line
/// where Y Cells is 1. Where Peak Area, Window Integral and Live Time are there, net counts are the
/// peak's area times the live time, and the background is what the window holds beyond it.
/// @throws InputError for an HDF5 file of another kind, one without a composition (only
/// intensities), sizes that do not fit X Cells and Y Cells, or no step.
std::variant<LineScan, ElementMap> read_h5oina(const std::filesystem::path& path);

}  // namespace meltproof::validation

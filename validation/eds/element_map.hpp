// SPDX-License-Identifier: GPL-3.0-or-later
// Element maps, and a line of given width through them.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "validation/eds/line_scan.hpp"

namespace meltproof::validation {

/// One element's map, row by row from the top left; NaN outside the scanned area.
struct MapLayer {
  std::vector<double> fraction;            ///< as reported, 1 for 100 %
  std::vector<double> uncertainty;         ///< standard uncertainty; empty if not reported
  std::vector<double> counts, background;  ///< net N and background B; empty if not reported
};

struct ElementMap {
  std::filesystem::path path;
  std::size_t width = 0, height = 0;
  double pixel_x = 0, pixel_y = 0;  ///< m
  bool of_atoms = false;
  std::map<std::string, MapLayer> layers;
  std::optional<double> voltage;               ///< kV
  std::vector<std::filesystem::path> sources;  ///< other files that it was read from
  std::vector<std::string> remarks;
};

/// A line scan from a map: points one pixel apart along the line, each the mean of bilinear samples
/// one pixel apart across the width. Its uncertainty is the larger of the standard error of that
/// mean, s / sqrt(n), and what the map's own uncertainties give, sqrt(sum u^2) / n. Counts add up
/// across the width.
/// @throws InputError if the line has no length, leaves the map, or meets a place not scanned.
LineScan sample_map(const ElementMap& map, const ScanOptions::MapLine& line);

/// Reads a map that a small TOML file describes: its unit, its pixel size, and one TIFF (8 or 16
/// bit integers, floating point) or HDF5 data set for each element; see map_description.cpp.
/// @throws InputError naming file and key for anything that cannot be used.
ElementMap read_described_map(const std::filesystem::path& path);
/// A TOML text with an [[element]] table.
bool is_map_description(std::string_view first_bytes);

}  // namespace meltproof::validation

// SPDX-License-Identifier: GPL-3.0-or-later
// One page of a TIFF as numbers.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace meltproof::validation {

struct Layer {
  std::size_t width = 0, height = 0;
  std::vector<double> values;  ///< row by row from the top left
  bool integers = false;       ///< stored as integers, which need a scale to mean percent
};

/// The first four bytes of a TIFF or BigTIFF.
bool is_tiff(std::string_view first_bytes);

/// The first page: one channel of 8, 16 or 32 bit integers or of floating point, in strips or
/// tiles. @throws InputError for colours, other depths, or a damaged file.
Layer read_tiff_layer(const std::filesystem::path& path);

}  // namespace meltproof::validation

// SPDX-License-Identifier: GPL-3.0-or-later
// Which index of a three-dimensional array counts frames, rows and columns.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace meltproof::imaging {

/// Positions of the indices in an array's shape.
struct ArrayAxes {
  std::size_t frame = 0, row = 1, column = 2;
};

/// Reads "fhw", "hwf" and so on: each letter once.
/// @throws InputError if the letters are others.
ArrayAxes parse_array_axes(const std::string& letters);

/// Brings a frame that is stored column after column into row-major order. Both have
/// height * width values.
void transpose(const std::vector<float>& columns, std::size_t height, std::size_t width,
               std::vector<float>& into);

}  // namespace meltproof::imaging

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

/// A frame as it comes out of an array, with the axis of frames left out, brought into row-major
/// order. `stored` has height * width values whose slower index is the row, or the column if
/// `columns_slow`.
void to_row_major(const std::vector<float>& stored, bool columns_slow, std::size_t height,
                  std::size_t width, std::vector<float>& into);

}  // namespace meltproof::imaging

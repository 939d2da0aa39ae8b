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

/// Which dimensions of an array count something: all of two or three; of more, those that are
/// not 1.
std::vector<std::size_t> counting_dims(const std::vector<std::size_t>& dims);

/// ArrayAxes::frame of an array that is one picture.
constexpr std::size_t no_axis = std::string::npos;
/// The dimensions that `letters` name, among the two or three counting ones.
/// @param reversed whether the file stores them in the other order than its language writes them.
ArrayAxes place_axes(const std::string& letters, const std::vector<std::size_t>& counting,
                     bool reversed);

/// Brings a frame that is stored column after column into row-major order. Both have
/// height * width values.
void transpose(const std::vector<float>& columns, std::size_t height, std::size_t width,
               std::vector<float>& into);

}  // namespace meltproof::imaging

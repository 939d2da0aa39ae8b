// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/array_axes.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace meltproof::imaging {

ArrayAxes parse_array_axes(const std::string& letters) {
  std::string sorted = letters;
  std::sort(sorted.begin(), sorted.end());
  if (sorted != "fhw")
    throw InputError("The axes of an array are \"" + letters +
                     "\"; expected the letters f (frame), h (row) and w (column), each once, as in "
                     "\"fhw\".");
  return {letters.find('f'), letters.find('h'), letters.find('w')};
}

void transpose(const std::vector<float>& columns, std::size_t height, std::size_t width,
               std::vector<float>& into) {
  for (std::size_t column = 0; column < width; ++column)
    for (std::size_t row = 0; row < height; ++row)
      into[row * width + column] = columns[column * height + row];
}

}  // namespace meltproof::imaging

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

std::vector<std::size_t> counting_dims(const std::vector<std::size_t>& dims) {
  std::vector<std::size_t> counting;
  for (std::size_t i = 0; i < dims.size(); ++i)
    if (dims.size() <= 3 || dims[i] != 1) counting.push_back(i);
  return counting;
}

ArrayAxes place_axes(const std::string& letters, const std::vector<std::size_t>& counting,
                     bool reversed) {
  std::string order = letters;
  const ArrayAxes named = parse_array_axes(order);
  if (counting.size() == 2) order.erase(named.frame, 1);
  if (reversed) std::reverse(order.begin(), order.end());
  const auto place = [&](char letter) {
    const auto at = order.find(letter);
    return at == std::string::npos ? no_axis : counting.at(at);
  };
  return {place('f'), place('h'), place('w')};
}

void transpose(const std::vector<float>& columns, std::size_t height, std::size_t width,
               std::vector<float>& into) {
  for (std::size_t column = 0; column < width; ++column)
    for (std::size_t row = 0; row < height; ++row)
      into[row * width + column] = columns[column * height + row];
}

}  // namespace meltproof::imaging

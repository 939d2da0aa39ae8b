// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/csv_numbers.hpp"

#include <functional>

namespace meltproof::imaging {
namespace {

constexpr std::size_t fewest = 4;

/// Whether value(from), value(from + 1), ... up to `count` are 0, 1, 2, ... or 1, 2, 3, ....
bool counts_up(const std::function<float(std::size_t)>& value, std::size_t from,
               std::size_t count) {
  if (count < from + fewest) return false;
  const float first = value(from);
  if (first != 0 && first != 1) return false;
  for (std::size_t i = from; i < count; ++i)
    if (value(i) != first + static_cast<float>(i - from)) return false;
  return true;
}

}  // namespace

CsvNumbers csv_numbers(const std::vector<float>& values, std::size_t width, std::size_t height) {
  const auto row = [&](std::size_t y) {
    return [&values, width, y](std::size_t x) { return values[y * width + x]; };
  };
  const auto column = [&](std::size_t x) {
    return [&values, width, x](std::size_t y) { return values[y * width + x]; };
  };
  if (width < 2 || height < 2) return {};
  // Both, behind a corner that is neither's; a picture that is a ramp has it in its next row too.
  if (counts_up(row(0), 1, width) && counts_up(column(0), 1, height) &&
      !counts_up(row(1), 1, width) && !counts_up(column(1), 1, height))
    return {true, true};
  return {counts_up(row(0), 0, width) && !counts_up(row(1), 0, width),
          counts_up(column(0), 0, height) && !counts_up(column(1), 0, height)};
}

void without_numbers(const std::vector<float>& values, std::size_t width, const CsvNumbers& numbers,
                     std::vector<float>& into) {
  const std::size_t first_column = numbers.column ? 1 : 0;
  std::size_t next = 0;
  for (std::size_t y = numbers.row ? 1 : 0; y * width < values.size(); ++y)
    for (std::size_t x = first_column; x < width; ++x) into[next++] = values[y * width + x];
}

}  // namespace meltproof::imaging

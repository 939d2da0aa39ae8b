// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers of rows and columns that a table brings along beside the pixels of a frame.
#pragma once

#include <cstddef>
#include <vector>

namespace meltproof::imaging {

/// Whether the first row holds the numbers of the columns, and the first column those of the rows.
struct CsvNumbers {
  bool row = false, column = false;
  bool operator==(const CsvNumbers&) const = default;
};

/// A row of numbers goes up by one from value to value, beginning with 0 or 1, and the row below it
/// does not; its first value may be missing or anything where a column of numbers stands below.
/// Fewer than four such values are pixels like others.
/// @param values height * width, row-major, as they stand in the file.
CsvNumbers csv_numbers(const std::vector<float>& values, std::size_t width, std::size_t height);

/// Takes that row and column away: `into` has the pixels that are left.
void without_numbers(const std::vector<float>& values, std::size_t width, const CsvNumbers& numbers,
                     std::vector<float>& into);

}  // namespace meltproof::imaging

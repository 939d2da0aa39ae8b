// SPDX-License-Identifier: GPL-3.0-or-later
// Names in front of the rows of a text: some software writes "Frame 1" there and nothing beside the
// rows that follow, some a name beside every row.
#pragma once

#include <string_view>

#include "imaging/recording/csv_row.hpp"

namespace meltproof::imaging {

/// What the first column of the rows of `text` is. It holds names if rows begin with a word and no
/// row of the same length begins with a number.
CsvFirst csv_first_column(std::string_view text, const CsvDialect& dialect);

/// Whether a row begins a frame by a name of its own.
bool csv_row_begins_frame(std::string_view line, const CsvDialect& dialect);

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// Commas between the values of a text, which may be decimal signs as well.
#pragma once

#include <filesystem>
#include <string_view>

#include "imaging/recording/csv_row.hpp"
#include "imaging/recording/options.hpp"

namespace meltproof::imaging {

/// Whether rows that were split at commas look as if every second comma was a decimal sign: the
/// first numbers of pairs follow one another four times as closely as the two of a pair (a picture
/// is smooth, its decimals are not), or second numbers begin with zeros. Whole numbers only, in
/// rows of an even length.
bool commas_look_decimal(std::string_view text);

/// @throws InputError if the commas of `text` can be read in two ways and the user has not said
///         which, or if the comma is said to be both separator and decimal sign and no value stands
///         in quotes.
void check_csv_commas(const std::filesystem::path& path, std::string_view text,
                      const CsvDialect& dialect, const ReadOptions& options);

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of numbers in text: which separator and which decimal sign, and their values.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "imaging/recording/options.hpp"

namespace meltproof::imaging {

/// What the first column is: a value like the others, a row's name, or the name of the frame that
/// begins there.
enum class CsvFirst { value, row_name, frame_name };

/// How a text writes rows of numbers.
struct CsvDialect {
  char separator = ',';
  char decimal = '.';
  CsvFirst first = CsvFirst::value;
};

/// What a line of text is: a row of at least two values of which one is a number and none a word; a
/// mixture of numbers and words; or something else.
enum class CsvLine { row, mixed, other };
/// Reads a line; `values` then has one entry a field. An empty field, a dash, NaN and a word are
/// NaN. A separator at the end of the line is allowed; with the separator "space" several count as
/// one.
CsvLine read_csv_line(std::string_view line, const CsvDialect& dialect, std::vector<float>& values);
/// A field that is a word, and its column, counted from 1 as a spreadsheet does.
struct CsvWord {
  std::size_t column = 0;  ///< 0: there is none
  std::string text;
};
/// The first word of a line.
CsvWord first_csv_word(std::string_view line, const CsvDialect& dialect);
/// Whether the line is a row, which `values` then holds.
bool parse_csv_row(std::string_view line, const CsvDialect& dialect, std::vector<float>& values);

/// The dialect in which most values of `text` stand in rows of one length, among tab, semicolon,
/// comma, bar and space with decimal point or comma (with both commas where values are quoted); a
/// separator or decimal sign in `options` is kept. Where no line is a row, rows behind names count.
/// @returns whether there is any row.
/// @throws InputError if an option is none of the choices.
bool detect_csv_dialect(std::string_view text, const ReadOptions& options, CsvDialect& dialect);

/// The unit that the words in front of the numbers name: "count", "K", "degC", "degF", or nothing.
/// Counts go before temperatures, because a preamble also lists the temperatures of air and camera;
/// two temperature scales contradict each other.
std::string csv_unit(std::string_view preamble);

}  // namespace meltproof::imaging

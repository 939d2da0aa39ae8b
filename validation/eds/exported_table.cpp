// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/exported_table.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "validation/csv.hpp"

namespace meltproof::validation {
namespace {

/// Exports write the micro sign in three ways and sigma in Greek.
std::string plain(std::string text) {
  const auto replace = [&text](const std::string& from, const std::string& to) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
      text.replace(at, from.size(), to);
    }
  };
  replace("\xCE\xB1", "a");  // of K-alpha: its second byte is a sign of its own in Latin-1
  replace("\xCE\xB2", "b");
  replace("\xC2\xB5", "u");
  replace("\xCE\xBC", "u");
  replace("\xC2\xB1", "+/-");
  replace("\xB1", "+/-");
  replace("\xB5", "u");
  replace("\xCF\x83", "sigma");
  return text;
}

/// UTF-16 (little-endian, as programs on Windows write it) as UTF-8. @throws InputError if it ends
/// within a character.
std::string from_utf16(const std::string& bytes, const std::string& place) {
  std::string text;
  if (bytes.size() % 2 != 0) {
    throw InputError(
        fmt::format("{}: the UTF-16 text ends within a character: it is cut off.", place));
  }
  for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
    const unsigned code = static_cast<unsigned char>(bytes[i]) |
                          static_cast<unsigned>(static_cast<unsigned char>(bytes[i + 1])) << 8;
    if (code < 0x80) {
      text += static_cast<char>(code);
    } else if (code < 0x800) {
      text += static_cast<char>(0xC0 | code >> 6);
      text += static_cast<char>(0x80 | (code & 0x3F));
    } else {  // halves of surrogate pairs stand in no header that is looked at
      text += static_cast<char>(0xE0 | code >> 12);
      text += static_cast<char>(0x80 | (code >> 6 & 0x3F));
      text += static_cast<char>(0x80 | (code & 0x3F));
    }
  }
  return text;
}

/// The cells of a line without the empty ones that separators at its end make.
std::vector<std::string> cells_of(const std::string& line, char separator) {
  auto cells = split_cells(line, separator);
  while (cells.size() > 1 && cells.back().empty()) {
    cells.pop_back();
  }
  return cells;
}

/// The line as numbers: no cell is anything else, but with `labelled` the first, a label.
bool is_numeric(const std::vector<std::string>& cells, bool decimal_comma, bool labelled) {
  const auto is_number = [&](const auto& cell) {
    return number_of(cell, decimal_comma).has_value();
  };
  return cells.size() >= (labelled ? 3u : 2u) && is_number(cells.front()) != labelled &&
         std::all_of(cells.begin() + 1, cells.end(), is_number);
}

struct Dialect {
  char separator = ',';
  bool decimal_comma = false;
  bool labelled = false;  ///< the first cell of every row is a label
};

bool is_row(const std::string& line, const Dialect& dialect) {
  return is_numeric(cells_of(line, dialect.separator), dialect.decimal_comma, dialect.labelled);
}

/// The dialect in which most lines are rows of numbers.
Dialect detect(const std::vector<std::string>& lines) {
  Dialect best;
  std::ptrdiff_t most = 0;
  for (const bool labelled : {false, true}) {
    for (const auto& [separator, comma] :
         {std::pair{',', false}, std::pair{';', false}, std::pair{';', true},
          std::pair{'\t', false}, std::pair{'\t', true}, std::pair{',', true}}) {
      const Dialect candidate{separator, comma, labelled};
      const auto rows = std::count_if(lines.begin(), lines.end(), [&](const std::string& line) {
        return is_row(line, candidate);
      });
      if (rows > most) {
        most = rows;
        best = candidate;
      }
    }
  }
  return best;
}

}  // namespace

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

ExportedTable read_exported_table(const std::filesystem::path& path) {
  std::string text = read_file(path);
  const std::string place = path.string();
  if (text.starts_with("\xFF\xFE")) {
    text = from_utf16(text, place);
  }
  if (text.find('\0') != std::string::npos) {
    throw InputError(
        fmt::format("{}: this is no text: expected a line scan exported as CSV.", place));
  }
  const auto lines = lines_of(plain(text));
  const Dialect dialect = detect(lines);
  ExportedTable table;
  std::size_t begin = 0;
  while (begin < lines.size() && !is_row(lines[begin], dialect)) {
    ++begin;
  }
  if (begin == lines.size()) {
    throw InputError(fmt::format(
        "{}: there is no row of numbers: expected a line scan exported as CSV.", place));
  }
  if (begin > 0 && !dialect.labelled) {
    // A row with a hole in it must not pass for a header.
    const auto above = cells_of(lines[begin - 1], dialect.separator);
    if (above.size() > 1 && number_of(above.front(), dialect.decimal_comma)) {
      throw InputError(fmt::format(
          "{}:{}: the line begins with a number, but one of its cells is no number: expected a row "
          "of numbers, of which only the last cells may be empty.",
          place, begin));
    }
  }
  table.first_line = begin + 1;
  auto columns = cells_of(lines[begin], dialect.separator).size();
  const auto cells_with_blanks = [&](std::size_t line) {
    return split_cells(lines[line], dialect.separator).size();
  };
  if (begin > 0 &&
      cells_with_blanks(begin) >= cells_of(lines[begin - 1], dialect.separator).size()) {
    // Its last cells may be empty, which means not known.
    columns = std::max(columns, cells_of(lines[begin - 1], dialect.separator).size());
  }
  for (std::size_t i = begin; i < lines.size() && !trimmed(lines[i]).empty(); ++i) {
    const auto cells = cells_of(lines[i], dialect.separator);
    std::vector<double> row;
    if (dialect.labelled) {
      row.push_back(std::numeric_limits<double>::quiet_NaN());
    }
    for (std::size_t k = dialect.labelled ? 1 : 0; k < cells.size(); ++k) {
      const auto& cell = cells[k];
      const auto value = number_of(cell, dialect.decimal_comma);
      if (!value || !std::isfinite(*value)) {
        throw InputError(fmt::format("{}:{}: \"{}\" is no number.", place, i + 1, cell));
      }
      row.push_back(*value);
    }
    while (row.size() < columns && row.size() < cells_with_blanks(i)) {
      row.push_back(std::numeric_limits<double>::quiet_NaN());
    }
    if (row.size() != columns) {
      throw InputError(fmt::format("{}:{}: found {} cells where the first row has {}.", place,
                                   i + 1, row.size(), columns));
    }
    table.rows.push_back(std::move(row));
  }
  // Up to two header lines stand directly above: names, or names and their units.
  table.header.assign(columns, "");
  std::size_t header = begin;
  while (header > 0 && begin - header < 2 &&
         cells_of(lines[header - 1], dialect.separator).size() == columns) {
    --header;
    const auto cells = cells_of(lines[header], dialect.separator);
    for (std::size_t i = 0; i < columns; ++i) {
      table.header[i] = trimmed(cells[i] + " " + table.header[i]);
    }
  }
  for (std::size_t i = 0; i < header; ++i) {
    table.preamble += lower(lines[i]) + "\n";
  }
  return table;
}

}  // namespace meltproof::validation

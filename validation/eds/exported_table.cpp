// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/exported_table.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

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
  replace("\xC2\xB5", "u");
  replace("\xCE\xBC", "u");
  replace("\xB5", "u");
  replace("\xCF\x83", "sigma");
  return text;
}

/// The line as numbers: at least two cells, the first one a number, and no cell with letters in it.
bool is_numeric(const std::vector<std::string>& cells, bool decimal_comma) {
  return cells.size() >= 2 && std::all_of(cells.begin(), cells.end(), [&](const auto& cell) {
           return number_of(cell, decimal_comma).has_value();
         });
}

struct Dialect {
  char separator = ',';
  bool decimal_comma = false;
};

/// The dialect in which most lines are rows of numbers.
Dialect detect(const std::vector<std::string>& lines) {
  const Dialect candidates[] = {{',', false},  {';', false}, {';', true},
                                {'\t', false}, {'\t', true}, {',', true}};
  Dialect best;
  std::ptrdiff_t most = 0;
  for (const auto& candidate : candidates) {
    const auto rows = std::count_if(lines.begin(), lines.end(), [&](const std::string& line) {
      return is_numeric(split_cells(line, candidate.separator), candidate.decimal_comma);
    });
    if (rows > most) {
      most = rows;
      best = candidate;
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
  const std::string text = read_file(path);
  const std::string place = path.string();
  if (text.find('\0') != std::string::npos) {
    throw InputError(
        fmt::format("{}: this is no text: expected a line scan exported as CSV.", place));
  }
  const auto lines = lines_of(plain(text));
  const Dialect dialect = detect(lines);
  ExportedTable table;
  std::size_t begin = 0;
  while (begin < lines.size() &&
         !is_numeric(split_cells(lines[begin], dialect.separator), dialect.decimal_comma)) {
    ++begin;
  }
  if (begin == lines.size()) {
    throw InputError(fmt::format(
        "{}: there is no row of numbers: expected a line scan exported as CSV.", place));
  }
  table.first_line = begin + 1;
  const auto columns = split_cells(lines[begin], dialect.separator).size();
  for (std::size_t i = begin; i < lines.size() && !trimmed(lines[i]).empty(); ++i) {
    const auto cells = split_cells(lines[i], dialect.separator);
    std::vector<double> row;
    for (const auto& cell : cells) {
      const auto value = number_of(cell, dialect.decimal_comma);
      if (!value || !std::isfinite(*value)) {
        throw InputError(fmt::format("{}:{}: \"{}\" is no number.", place, i + 1, cell));
      }
      row.push_back(*value);
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
         split_cells(lines[header - 1], dialect.separator).size() == columns) {
    --header;
    const auto cells = split_cells(lines[header], dialect.separator);
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

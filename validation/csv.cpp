// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/csv.hpp"

#include <algorithm>
#include <charconv>

namespace meltproof::validation {

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) {
    return {};
  }
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

std::vector<std::string> lines_of(const std::string& text) {
  std::string_view rest = text;
  if (rest.starts_with("\xEF\xBB\xBF")) {
    rest.remove_prefix(3);
  }
  std::vector<std::string> lines;
  while (!rest.empty()) {
    const auto end = rest.find('\n');
    std::string_view line = rest.substr(0, end);
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    lines.emplace_back(line);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  return lines;
}

std::vector<std::string> split_cells(const std::string& line, char separator) {
  std::vector<std::string> cells;
  std::string cell;
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"') {
      if (quoted && i + 1 < line.size() && line[i + 1] == '"') {
        cell += c;
        ++i;
      } else {
        quoted = !quoted;
      }
    } else if (c == separator && !quoted) {
      cells.push_back(trimmed(cell));
      cell.clear();
    } else {
      cell += c;
    }
  }
  cells.push_back(trimmed(cell));
  return cells;
}

std::optional<double> number_of(const std::string& cell, bool decimal_comma) {
  std::string text = trimmed(cell);
  if (decimal_comma) {
    if (text.find('.') != std::string::npos) {
      return std::nullopt;
    }
    std::replace(text.begin(), text.end(), ',', '.');
  }
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* const end = text.data() + text.size();
  double value = 0;
  const auto [stop, problem] = std::from_chars(begin, end, value);
  if (problem != std::errc() || stop != end) {
    return std::nullopt;
  }
  return value;
}

ColumnHeader parse_header(const std::string& cell) {
  const auto open = cell.rfind('[');
  const auto close = cell.rfind(']');
  if (open == std::string::npos || close == std::string::npos || close < open) {
    return {trimmed(cell), ""};
  }
  return {trimmed(cell.substr(0, open)), trimmed(cell.substr(open + 1, close - open - 1))};
}

}  // namespace meltproof::validation

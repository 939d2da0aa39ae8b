// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/csv_labels.hpp"

#include <algorithm>
#include <map>
#include <vector>

namespace meltproof::imaging {

CsvFirst csv_first_column(std::string_view text, const CsvDialect& dialect) {
  const CsvDialect values_only{dialect.separator, dialect.decimal, CsvFirst::value};
  const CsvDialect named{dialect.separator, dialect.decimal, CsvFirst::row_name};
  struct Count {
    std::size_t named = 0, bare = 0, numbered = 0;
  };
  std::map<std::size_t, Count> by_width;  // of the row without its first field
  std::vector<float> values;
  for (std::size_t at = 0; at < text.size();) {
    const auto end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    at = end + 1;
    if (!parse_csv_row(line, named, values)) continue;
    auto& count = by_width[values.size()];
    if (csv_row_begins_frame(line, {dialect.separator, dialect.decimal, CsvFirst::frame_name})) {
      ++(parse_csv_row(line, values_only, values) ? count.numbered : count.named);
    } else {
      ++count.bare;
    }
  }
  const auto main =
      std::max_element(by_width.begin(), by_width.end(), [](const auto& a, const auto& b) {
        const auto rows = [](const auto& entry) {
          return entry.first * (entry.second.named + entry.second.bare + entry.second.numbered);
        };
        return rows(a) < rows(b);
      });
  if (main == by_width.end()) return CsvFirst::value;
  const Count& rows = main->second;
  if (rows.named == 0 || rows.numbered > 0) return CsvFirst::value;
  if (rows.bare > 0) return CsvFirst::frame_name;
  // A single row with a word in front is more likely part of a preamble.
  return rows.named > 1 ? CsvFirst::row_name : CsvFirst::value;
}

bool csv_row_begins_frame(std::string_view line, const CsvDialect& dialect) {
  if (dialect.first != CsvFirst::frame_name) return false;
  const auto name = line.find_first_not_of(" \t\r\"\xEF\xBB\xBF");
  const auto end = line.find(dialect.separator);
  return name != std::string_view::npos && name < end;
}

}  // namespace meltproof::imaging

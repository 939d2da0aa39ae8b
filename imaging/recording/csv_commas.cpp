// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/csv_commas.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace meltproof::imaging {
namespace {

/// Calls `visit` with every row until it returns false. @returns whether it never did.
bool every_row(std::string_view text, const CsvDialect& dialect,
               const std::function<bool(std::string_view, const std::vector<float>&)>& visit) {
  std::vector<float> values;
  for (std::size_t at = 0; at < text.size();) {
    const auto end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    if (parse_csv_row(line, dialect, values) && !visit(line, values)) return false;
    at = end + 1;
  }
  return true;
}

/// Whether the numbers of a row with odd positions (the second of each pair) are digits only, and
/// which of both begin with a zero that a whole number has no use for.
bool digits_follow(std::string_view line, bool& first_zeros, bool& second_zeros) {
  while (line.ends_with('\r') || line.ends_with(',') || line.ends_with(' ')) line.remove_suffix(1);
  for (std::size_t at = 0, column = 0; at < line.size(); ++column) {
    const auto end = std::min(line.find(',', at), line.size());
    const std::string_view field = line.substr(at, end - at);
    const bool digits = !field.empty() && field.find_first_not_of("0123456789") == field.npos;
    if (column % 2 == 1 && !digits) return false;
    if (field.size() > 1 && field.front() == '0')
      (column % 2 == 0 ? first_zeros : second_zeros) = true;
    at = end + 1;
  }
  return true;
}

}  // namespace

bool commas_look_decimal(std::string_view text) {
  double along = 0, across = 0;  // first to first of the next pair; first to second
  std::size_t pairs = 0, unequal = 0;
  bool first_zeros = false, second_zeros = false;
  const bool may_be =
      every_row(text, {',', '.'}, [&](std::string_view line, const std::vector<float>& values) {
        if (values.size() == 2) return true;  // a size or a time in front of the frames
        if (values.size() % 2 != 0 || line.find_first_of(".\"eE") != line.npos) return false;
        for (std::size_t i = 0; i + 1 < values.size(); i += 2) {
          ++pairs;
          unequal += values[i] != values[i + 1] ? 1U : 0U;
          across += std::abs(values[i + 1] - values[i]);
          if (i + 2 < values.size()) along += std::abs(values[i + 2] - values[i]);
        }
        return digits_follow(line, first_zeros, second_zeros);
      });
  if (!may_be || pairs == 0) return false;
  // On a flat background a few bright pixels decide both sums, so most pairs must have a say.
  const bool alternates = 4 * along < across && 4 * unequal >= 3 * pairs;
  return alternates || (second_zeros && !first_zeros);
}

void check_csv_commas(const std::filesystem::path& path, std::string_view text,
                      const CsvDialect& dialect, const ReadOptions& options) {
  if (dialect.separator != ',' || dialect.first != CsvFirst::value) return;
  const bool quoted = !every_row(text, dialect, [](std::string_view line, const auto&) {
    return line.find('"') == line.npos;
  });
  if (dialect.decimal == ',' && !quoted)
    throw InputError(path.string() +
                     ": the comma cannot be decimal sign and separator at once unless the values "
                     "stand in quotes; export the file anew with semicolons or tabs between the "
                     "values, or say decimal = \".\" if they are whole numbers.");
  if (dialect.decimal == '.' && options.decimal.empty() && commas_look_decimal(text))
    throw InputError(path.string() +
                     ": commas stand between whole numbers that alternate as numbers and their "
                     "decimals do, so 20,1,20,2 may be two values or four; export the file anew "
                     "with semicolons or tabs between the values, or say decimal = \".\" if they "
                     "are whole numbers.");
}

}  // namespace meltproof::imaging

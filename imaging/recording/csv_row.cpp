// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/csv_row.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>
#include <map>

#include "base/error.hpp"
#include "imaging/recording/csv_labels.hpp"

namespace meltproof::imaging {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") + 1 - begin);
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

/// A field is a number, stands for a missing one, or makes the line a text.
enum class Field { number, missing, text };

Field parse_field(std::string_view field, char decimal, float& value) {
  constexpr std::size_t longest = 64;
  value = std::numeric_limits<float>::quiet_NaN();
  field = trimmed(field);
  if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
    field = trimmed(field.substr(1, field.size() - 2));
  if (field.starts_with('+')) field.remove_prefix(1);
  if (field.find_first_not_of('-') == std::string_view::npos) return Field::missing;
  if (field.size() > longest) return Field::text;
  char copy[longest];
  std::copy(field.begin(), field.end(), copy);
  char* end = copy + field.size();
  if (decimal != '.') {
    if (std::find(copy, end, '.') != end) return Field::text;
    std::replace(copy, end, decimal, '.');
  }
  const auto result = std::from_chars(copy, end, value);
  if (result.ec == std::errc::result_out_of_range) return Field::missing;
  if (result.ec == std::errc() && result.ptr == end)
    return value == value ? Field::number : Field::missing;
  value = std::numeric_limits<float>::quiet_NaN();
  return lower(field) == "n/a" ? Field::missing : Field::text;
}

/// Where the field that begins at `at` ends: at the next separator outside quotes.
std::size_t field_end(std::string_view line, std::size_t at, char separator) {
  const auto first = line.find_first_not_of(' ', at);
  if (first != std::string_view::npos && line[first] == '"') {
    const auto quote = line.find('"', first + 1);
    if (quote != std::string_view::npos) at = quote;
  }
  return std::min(line.find(separator, at), line.size());
}

/// A line without what surrounds its fields: UTF-8's mark, its end, blanks.
std::string_view bare_line(std::string_view line, char separator) {
  if (line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return separator == '\t' ? line : trimmed(line);
}

/// Takes the next field off a bare line. @returns whether there was one.
bool take_field(std::string_view& line, char separator, std::string_view& field) {
  if (line.empty()) return false;
  const std::size_t end = field_end(line, 0, separator);
  field = line.substr(0, end);
  line.remove_prefix(std::min(end + 1, line.size()));
  if (separator == ' ') line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  return true;
}

/// How many values stand in rows of the length that has most.
std::size_t most_values_of_a_width(std::string_view text, const CsvDialect& dialect) {
  std::vector<float> values;
  std::map<std::size_t, std::size_t> by_width;
  std::size_t most = 0;
  for (std::size_t at = 0; at < text.size();) {
    const auto end = std::min(text.find('\n', at), text.size());
    if (parse_csv_row(text.substr(at, end - at), dialect, values))
      most = std::max(most, by_width[values.size()] += values.size());
    at = end + 1;
  }
  return most;
}

const std::map<std::string, char> named_separators = {
    {"tab", '\t'}, {"space", ' '}, {"comma", ','}, {"semicolon", ';'}};

}  // namespace

bool parse_csv_row(std::string_view line, const CsvDialect& dialect, std::vector<float>& values) {
  return read_csv_line(line, dialect, values) == CsvLine::row;
}

CsvLine read_csv_line(std::string_view line, const CsvDialect& dialect,
                      std::vector<float>& values) {
  values.clear();
  line = bare_line(line, dialect.separator);
  bool number = false, text = false;
  std::string_view content;
  if (dialect.first != CsvFirst::value) take_field(line, dialect.separator, content);
  for (; take_field(line, dialect.separator, content);) {
    float value = 0;
    const Field field = parse_field(content, dialect.decimal, value);
    number |= field == Field::number;
    text |= field == Field::text;
    values.push_back(value);
  }
  if (!number || values.size() < 2) return CsvLine::other;
  return text ? CsvLine::mixed : CsvLine::row;
}

CsvWord first_csv_word(std::string_view line, const CsvDialect& dialect) {
  line = bare_line(line, dialect.separator);
  float value = 0;
  std::size_t column = 1;
  std::string_view field;
  if (dialect.first != CsvFirst::value && take_field(line, dialect.separator, field)) ++column;
  for (; take_field(line, dialect.separator, field); ++column)
    if (parse_field(field, dialect.decimal, value) == Field::text)
      return {column, std::string(trimmed(field))};
  return {};
}

bool detect_csv_dialect(std::string_view text, const ReadOptions& options, CsvDialect& dialect) {
  std::string separators = "\t;,| ";
  if (!options.separator.empty()) {
    const auto named = named_separators.find(options.separator);
    separators =
        named == named_separators.end() ? options.separator : std::string(1, named->second);
    if (separators.size() != 1 || std::string("\t;,| ").find(separators) == std::string::npos)
      throw InputError("The separator of a CSV file is \"" + options.separator +
                       "\"; expected tab, space, or one of , ; |.");
  }
  std::string decimals = ".,";
  if (!options.decimal.empty()) {
    if (options.decimal != "." && options.decimal != ",")
      throw InputError("The decimal sign of a CSV file is \"" + options.decimal +
                       "\"; expected \".\" or \",\".");
    decimals = options.decimal;
  }
  std::size_t best = 0;
  for (const CsvFirst first : {CsvFirst::value, CsvFirst::row_name}) {
    for (const char separator : separators)
      for (const char decimal : decimals) {
        const CsvDialect candidate{separator, decimal, first};
        const std::size_t count = most_values_of_a_width(text, candidate);
        if (count > best) {
          best = count;
          dialect = candidate;
        }
      }
    if (best > 0) break;
  }
  if (best > 0) dialect.first = csv_first_column(text, dialect);
  return best > 0;
}

std::string csv_unit(std::string_view preamble) {
  const std::string text = lower(preamble);
  const auto says = [&](std::initializer_list<const char*> words) {
    return std::any_of(words.begin(), words.end(),
                       [&](const char* word) { return text.find(word) != std::string::npos; });
  };
  if (says({"counts", "digital level", "[dl]", "(dl)"})) return "count";
  // The degree sign is the byte 260 (octal) in Latin-1, and ends in it in UTF-8.
  const bool celsius = says({"\260c", "celsius", "degc", "deg c", "[c]", "(c)"});
  const bool fahrenheit = says({"\260f", "fahrenheit", "degf", "deg f", "[f]", "(f)"});
  const bool kelvin = says({"kelvin", "[k]", "(k)", "unit=k", "unit: k"});
  if (int{celsius} + int{fahrenheit} + int{kelvin} != 1) return "";
  return celsius ? "degC" : fahrenheit ? "degF" : "K";
}

}  // namespace meltproof::imaging

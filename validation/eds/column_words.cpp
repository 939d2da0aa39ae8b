// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/column_words.hpp"

#include <algorithm>
#include <cctype>
#include <regex>

#include "validation/csv.hpp"
#include "validation/eds/elements.hpp"
#include "validation/eds/exported_table.hpp"

namespace meltproof::validation {
namespace {

bool contains(const std::string& text, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](const char* word) { return text.find(word) != std::string::npos; });
}

/// The text in the last pair of round or square brackets.
std::string bracketed(const std::string& header) {
  const auto open = header.find_last_of("[(");
  const auto close = header.find_last_of("])");
  if (open == std::string::npos || close == std::string::npos || close < open) {
    return "";
  }
  return trimmed(header.substr(open + 1, close - open - 1));
}

}  // namespace

Share share_named_in(const std::string& text) {
  if (contains(text, {"wt%", "wt.%", "wt %", "wt. %", "wt.-%", "weight", "mass", "gew"})) {
    return Share::mass;
  }
  return contains(text, {"at%", "at.%", "at %", "at. %", "at.-%", "atom"}) ? Share::atom
                                                                           : Share::none;
}

std::optional<double> length_unit_named_in(const std::string& header) {
  std::string word;
  std::optional<double> unit;
  for (const char c : lower(header) + " ") {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      word += c;
      continue;
    }
    unit = word == "nm" ? 1e-9 : word == "um" ? 1e-6 : word == "mm" ? 1e-3 : unit;
    word.clear();
  }
  return unit;
}

ColumnWords read_column_header(const std::string& header) {
  const std::string words = lower(header);
  ColumnWords column;
  column.unit = bracketed(header);
  const bool uncertain = contains(words, {"sigma", "error", "uncert", "+/-", "std", "fehler"});
  if (words.starts_with("concentration") || contains(words, {"alsi10mg"})) {
    column.role =
        uncertain || words.starts_with("concentration_u") ? Role::alloy_uncertainty : Role::alloy;
    return column;
  }
  column.element = element_named_in(header);
  column.share = share_named_in(words);
  const bool rate = contains(words, {"cps", "counts/s", "intens", "k-ratio", "k ratio"});
  if (contains(words, {"total", "sum"})) {
    column.role = Role::total;
  } else if (column.element.empty() || rate) {
    column.role = Role::other;
  } else if (contains(words, {"count"})) {
    column.role = contains(words, {"background", "bkg", "bkgd"}) ? Role::background : Role::counts;
  } else if (uncertain) {
    column.role = Role::uncertainty;
    std::smatch times;
    if (std::regex_search(words, times, std::regex("([1-9])[ -]*sigma"))) {
      column.coverage = std::stod(times[1]);
    }
    column.relative = contains(words, {"rel.", "rel ", "relative"});
  } else {
    column.role = Role::fraction;
    column.normalised =
        contains(words, {"norm"}) && !contains(words, {"unn", "un-norm", "not norm"});
    if (column.share == Share::none && !column.unit.empty() && column.unit != "%") {
      column.share = Share::unknown;
    }
  }
  return column;
}

}  // namespace meltproof::validation

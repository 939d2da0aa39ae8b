// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/compare/rule.hpp"

#include <cmath>
#include <map>

#include <fmt/format.h>

#include "base/error.hpp"

namespace meltproof::validation {
namespace {

template <class T>
T needed(const Row& row, const std::optional<T>& value, const char* what) {
  if (!value) {
    throw InputError(
        fmt::format("row \"{}\": its rule {} needs {}, which metric \"{}\" did not give.", row.name,
                    row.rule, what, row.metric));
  }
  return *value;
}

struct Rule {
  bool (*obeys)(const Row&, const RowNumbers&);
  std::string (*text)(const Row&);
};

const std::map<std::string, Rule>& rules() {
  static const std::map<std::string, Rule> all = {
      {"at_least",
       {[](const Row& row, const RowNumbers& n) {
          return needed(row, n.simulated, "S") >= row.limit;
        },
        [](const Row& row) {
          return fmt::format("S >= {:g}{}", row.limit, row.unit == "1" ? "" : " " + row.unit);
        }}},
      {"at_most",
       {[](const Row& row, const RowNumbers& n) {
          return needed(row, n.simulated, "S") <= row.limit;
        },
        [](const Row& row) {
          return fmt::format("S <= {:g}{}", row.limit, row.unit == "1" ? "" : " " + row.unit);
        }}},
      {"rises",
       {[](const Row& row, const RowNumbers& n) { return needed(row, n.rises, "a trend"); },
        [](const Row& row) { return fmt::format("every rise > {:g} u", row.coverage); }}},
      {"within_uncertainty",
       {[](const Row& row, const RowNumbers& n) {
          return std::abs(needed(row, n.error, "E")) <=
                 row.coverage * needed(row, n.u_val, "u_val");
        },
        [](const Row& row) { return fmt::format("|E| <= {:g} u_val", row.coverage); }}},
  };
  return all;
}

}  // namespace

std::vector<std::string> rule_names() {
  std::vector<std::string> names;
  for (const auto& [name, rule] : rules()) {
    names.push_back(name);
  }
  return names;
}

bool obeys(const Row& row, const RowNumbers& numbers) {
  return rules().at(row.rule).obeys(row, numbers);
}

std::string rule_text(const Row& row) { return rules().at(row.rule).text(row); }

}  // namespace meltproof::validation

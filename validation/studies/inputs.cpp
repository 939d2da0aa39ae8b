// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/studies/inputs.hpp"

#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/units.hpp"
#include "validation/metrics/sensitivity.hpp"

namespace meltproof::validation {
namespace {

using nlohmann::json;

/// What stands behind the number of "40 um"; "1" for a pure number.
std::string unit_of(const std::string& text) {
  const auto after = text.find_first_not_of("0123456789.+-eE ");
  return after == std::string::npos ? "1" : text.substr(after);
}

/// A quantity of a series in a unit, with a message that names the series.
double quantity(const StudySeries& series, const std::string& text, const std::string& unit) {
  try {
    return parse_quantity(text, unit);
  } catch (const InputError& problem) {
    throw InputError(
        fmt::format("the input \"{}\" ({}): {}.", series.name, series.key, problem.what()));
  }
}

}  // namespace

double result_number(const json& result, const std::string& key, const std::string& run) {
  if (!result.contains(key) || !result[key].is_number()) {
    throw InputError(
        fmt::format("{}.json: it holds no number {}: remove it and run `make studies`.", run, key));
  }
  return result[key].get<double>();
}

json input_facts(const StudySeries& series) {
  json facts = {{"key", series.key},
                {"value_text", series.value},
                {"u_text", series.uncertainty},
                {"reason", series.reason},
                {"logarithmic", series.logarithmic},
                {"value", nullptr},
                {"unit", nullptr},
                {"relative_uncertainty", nullptr}};
  if (!series.value.empty()) {
    const std::string unit = unit_of(series.value);
    const double value = quantity(series, series.value, unit);
    const bool share = series.uncertainty.ends_with("%") && unit_of(series.value) != "%";
    const double u = quantity(series, series.uncertainty, share ? "1" : unit);
    facts["value"] = value;
    facts["unit"] = unit;
    facts["relative_uncertainty"] = share ? u : std::abs(u / value);
  }
  return facts;
}

json input_effect(const StudySeries& series, const std::vector<FinishedRun>& runs,
                  const std::string& quantity_name) {
  const json facts = input_facts(series);
  const std::string key = quantity_name + "_um";
  json effect = {
      {"changes", json::array()}, {"left_out", json::array()}, {"relative_sensitivity", nullptr},
      {"relative_u", nullptr},    {"one_sided", false},        {"same_side", false}};
  double base = 0;
  for (const auto& run : runs) {
    base = run.declared->name == series.base ? result_number(run.result, key, series.base) : base;
  }
  std::vector<VariedInput> varied;
  std::vector<double> alternatives;
  for (const auto& run : runs) {
    const std::string& name = run.declared->name;
    if (name == series.base) {
      continue;
    }
    if (result_number(run.result, "clumped_fraction", name) >= clumped_allowed) {
      effect["left_out"].push_back(name);
      continue;
    }
    const double result = result_number(run.result, key, name);
    const std::string setting = setting_of(*run.declared, series.key);
    effect["changes"].push_back(
        {{"run", name}, {"setting", setting}, {"change", result / base - 1}});
    alternatives.push_back(result);
    if (!series.value.empty()) {
      varied.push_back({quantity(series, setting, facts["unit"]), result});
    }
  }
  if (alternatives.empty()) {
    return effect;
  }
  effect["one_sided"] = alternatives.size() == 1;
  if (series.value.empty()) {
    effect["relative_u"] = choice_uncertainty(base, alternatives);
    return effect;
  }
  try {
    const auto found = sensitivity(facts["value"], facts["relative_uncertainty"], base, varied,
                                   series.logarithmic);
    effect["relative_sensitivity"] = found.relative;
    effect["relative_u"] = found.uncertainty;
    effect["same_side"] = found.same_side;
  } catch (const InputError& problem) {
    throw InputError(
        fmt::format("the input \"{}\", {}: {}", series.name, quantity_name, problem.what()));
  }
  return effect;
}

}  // namespace meltproof::validation

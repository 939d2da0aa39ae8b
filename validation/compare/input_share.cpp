// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/compare/input_share.hpp"

#include <cmath>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/units.hpp"
#include "validation/csv.hpp"

namespace meltproof::validation {
namespace {

using nlohmann::json;

/// Inputs whose uncertainty in this row is another one than in the studies.
std::map<std::string, double> own_uncertainties(const Row& row) {
  std::map<std::string, double> own;
  for (const auto& entry : row.simulated.inputs) {
    const auto equals = entry.find('=');
    if (equals == std::string::npos) {
      throw InputError(fmt::format("row \"{}\": the input \"{}\" is none: expected \"name = 5 %\".",
                                   row.name, entry));
    }
    try {
      own[trimmed(entry.substr(0, equals))] = parse_quantity(entry.substr(equals + 1), "1");
    } catch (const InputError& problem) {
      throw InputError(
          fmt::format("row \"{}\": the input \"{}\": {}.", row.name, entry, problem.what()));
    }
  }
  return own;
}

}  // namespace

InputShare input_share(const Row& row, const Places& places) {
  InputShare share;
  const std::string& quantity = row.simulated.study;
  auto own = own_uncertainties(row);
  if (quantity.empty() || !std::filesystem::is_regular_file(places.studies)) {
    return share;
  }
  const json found =
      read_json(places.studies).value("inputs", json::object()).value(quantity, json::object());
  const json sensitivities = found.value("sensitivities", json::object());
  double square = 0;
  const json parts = found.value("parts", json::object());
  for (const auto& [name, part] : parts.items()) {
    double relative = part.get<double>();
    if (const auto at = own.find(name); at != own.end()) {
      const json& slope = sensitivities.at(name);
      if (!slope.is_number() && at->second != 0) {
        throw InputError(fmt::format(
            "row \"{}\": the input \"{}\" is a choice between laws: only 0 % can be said of it.",
            row.name, name));
      }
      relative = at->second == 0 ? 0 : std::abs(slope.get<double>()) * at->second;
      own.erase(at);
    }
    share.parts[name] = relative;
    square += relative * relative;
  }
  for (const auto& name : found.value("missing", json::array())) {
    const auto at = own.find(name.get<std::string>());
    if (at == own.end() || at->second != 0) {
      share.missing.push_back(name.get<std::string>());
    }
    if (at != own.end()) {
      own.erase(at);
    }
  }
  if (!own.empty() && !found.empty()) {
    throw InputError(
        fmt::format("row \"{}\": the studies know no input \"{}\".", row.name, own.begin()->first));
  }
  if (!share.parts.empty()) {
    share.relative = std::sqrt(square);
  }
  return share;
}

}  // namespace meltproof::validation

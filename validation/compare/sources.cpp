// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/compare/sources.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/units.hpp"
#include "validation/compare/recordings.hpp"

namespace meltproof::validation {

using nlohmann::json;

json read_json(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) {
    throw InputError(
        fmt::format("the result {} is missing: run the stage that makes it.", path.string()));
  }
  try {
    return json::parse(read_file(path));
  } catch (const json::parse_error& problem) {
    throw InputError(fmt::format("{}: this is no JSON: broken off or damaged at byte {}.",
                                 path.string(), problem.byte));
  }
}

double number_at(const json& document, const std::string& pointer,
                 const std::filesystem::path& path) {
  json value;
  try {
    value = document.value(json::json_pointer(pointer), json());
  } catch (const json::exception&) {
    throw InputError(fmt::format(
        "\"{}\" is no JSON pointer into {}: expected, for example, \"/pool_length_um\".", pointer,
        path.string()));
  }
  if (!value.is_number() || !std::isfinite(value.get<double>())) {
    throw InputError(fmt::format("{}: there is {} at {}: expected a number.", path.string(),
                                 value.is_null() ? "nothing" : value.dump(), pointer));
  }
  return value.get<double>();
}

namespace {

/// The relative standard uncertainty that the studies found for a quantity.
std::optional<double> studied_share(const std::string& quantity, const Places& places) {
  if (quantity.empty() || !std::filesystem::is_regular_file(places.studies)) {
    return std::nullopt;
  }
  const json document = read_json(places.studies);
  const json quantities = document.value("quantities", json::object());
  if (!quantities.contains(quantity) || quantities[quantity]["relative_u"].is_null()) {
    return std::nullopt;  // none of its runs is there yet
  }
  return number_at(document, "/quantities/" + quantity + "/relative_u", places.studies);
}

}  // namespace

SimulatedNumber simulated_number(const Row& row, const std::string& file, const Places& places) {
  const auto& source = row.simulated;
  const auto path = places.results / file;
  const json document = read_json(path);
  const auto in_unit = [&](const std::string& pointer) {
    return convert_unit(number_at(document, pointer, path), source.unit, row.unit);
  };
  SimulatedNumber result;
  result.value = source.over.empty() ? in_unit(source.value)
                                     : number_at(document, source.value, path) /
                                           number_at(document, source.over, path);
  if (!source.uncertainty.empty()) {
    result.parts["scatter"] = in_unit(source.uncertainty);
  }
  const auto share = studied_share(source.study, places);
  result.studied = source.study.empty() || share.has_value();
  if (share) {
    result.parts["studies"] = *share * std::abs(result.value);
  } else if (!source.spacing.empty()) {
    result.parts["spacing"] = in_unit(source.spacing) / std::sqrt(6.0);
  }
  double square = 0;
  for (const auto& part : result.parts) {
    square += std::pow(part.get<double>(), 2);
  }
  if (!result.parts.empty()) {
    result.uncertainty = std::sqrt(square);
  }
  return result;
}

VerificationNumber verification_number(const Row& row, const Places& places) {
  const json document = read_json(places.verification);
  const json cases = document.value("cases", json::array());
  const auto& wanted = row.simulated.verification_case;
  const auto at = std::find_if(cases.begin(), cases.end(), [&](const json& entry) {
    return entry.value("name", "") == wanted;
  });
  if (at == cases.end()) {
    throw InputError(fmt::format("{}: it holds no case \"{}\" among its {}.",
                                 places.verification.string(), wanted, cases.size()));
  }
  VerificationNumber result{number_at(*at, "/error", places.verification),
                            number_at(*at, "/asked", places.verification)};
  for (const auto& sentence : at->value("broken", json::array())) {
    result.broken.push_back(sentence.get<std::string>());
  }
  return result;
}

std::vector<std::filesystem::path> simulated_files(const Row& row, const Places& places) {
  std::vector<std::filesystem::path> paths;
  if (!row.simulated.verification_case.empty()) {
    paths.push_back(places.verification);
  }
  if (!row.simulated.file.empty()) {
    paths.push_back(places.results / row.simulated.file);
  }
  for (const auto& file : row.simulated.files) {
    paths.push_back(places.results / file);
  }
  return paths;
}

Campaign reference_campaign(const Row& row, const Places& places) {
  return read_campaign(places.experiments / row.reference.campaign);
}

std::vector<std::filesystem::path> recordings(const Row& row, const Places& places) {
  std::vector<std::filesystem::path> paths;
  for (const auto& name : row.reference.recordings) {
    paths.push_back(places.experiments / row.reference.campaign / name);
  }
  return paths;
}

namespace {

Datum published_number(const Row& row, const Places& places) {
  const Campaign campaign = reference_campaign(row, places);
  const auto& file = campaign.file(row.reference.file);
  return datum(file, row.reference.column, file.row(row.reference.where));
}

}  // namespace

Datum reference_number(const Row& row, const Places& places) {
  Datum result = row.reference.recordings.empty()
                     ? published_number(row, places)
                     : recorded_quantity(recordings(row, places), row.reference.column).datum;
  if (!result.value) {
    return result;
  }
  const double extra = row.reference.relative_uncertainty * *result.value;
  if (extra > 0) {
    result.uncertainty = std::hypot(result.uncertainty.value_or(0), extra);
  }
  result.value = convert_unit(*result.value, result.unit, row.unit);
  if (result.uncertainty) {
    result.uncertainty = convert_unit(*result.uncertainty, result.unit, row.unit);
  }
  result.unit = row.unit;
  return result;
}

}  // namespace meltproof::validation

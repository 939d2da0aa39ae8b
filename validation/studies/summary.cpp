// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/studies/summary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "validation/metrics/grid_convergence.hpp"

namespace meltproof::validation {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::array quantities = {"length", "width", "depth"};
constexpr double clumped_allowed = 0.01;

std::optional<json> read_result(const fs::path& path) {
  if (!fs::is_regular_file(path)) {
    return std::nullopt;
  }
  const json result = json::parse(read_file(path), nullptr, false);
  if (!result.is_object()) {
    throw InputError(fmt::format("{}: this is no JSON object: remove it and run `make studies`.",
                                 path.string()));
  }
  return result;
}

double number(const json& result, const std::string& key, const std::string& run) {
  if (!result.contains(key) || !result[key].is_number()) {
    throw InputError(
        fmt::format("{}.json: it holds no number {}: remove it and run `make studies`.", run, key));
  }
  return result[key].get<double>();
}

/// The runs of a series that are there.
struct Found {
  std::vector<std::string> names;
  std::vector<json> results;
};

json resolution(const Found& found, const std::string& base, const std::string& quantity) {
  std::array<double, 3> spacing{}, value{};
  std::size_t base_at = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t k = 2 - i;  // declared from coarse to fine
    spacing[i] = number(found.results[k], "spacing_um", found.names[k]);
    value[i] = number(found.results[k], quantity + "_um", found.names[k]);
    base_at = found.names[k] == base ? i : base_at;
  }
  const auto r = resolution_series(spacing, value);
  json j = {{"behaviour", r.behaviour},
            {"spacings_um", spacing},
            {"values_um", value},
            {"u_um", r.uncertainty},
            {"u_base_um", r.uncertainty[base_at]},
            {"relative_u", r.uncertainty[base_at] / value[base_at]},
            {"order", nullptr},
            {"extrapolated_um", nullptr}};
  if (r.behaviour == "converges") {
    j["order"] = r.order;
    j["order_used"] = r.order_used;
    j["extrapolated_um"] = r.extrapolated;
  }
  return j;
}

json spread(const Found& found, const std::string& base, const std::string& quantity) {
  double low = 0, high = 0, at_base = 0;
  bool first = true;
  json left_out = json::array();
  for (std::size_t i = 0; i < found.names.size(); ++i) {
    const double value = number(found.results[i], quantity + "_um", found.names[i]);
    if (found.names[i] == base) {
      at_base = value;
    } else if (number(found.results[i], "clumped_fraction", found.names[i]) >= clumped_allowed) {
      left_out.push_back(found.names[i]);
      continue;
    }
    low = first ? value : std::min(low, value);
    high = first ? value : std::max(high, value);
    first = false;
  }
  const double u = (high - low) / (2 * std::sqrt(3.0));
  return {{"u_base_um", u}, {"relative_u", u / at_base}, {"left_out", left_out}};
}

}  // namespace

json summarise(const StudyDeclaration& studies, const fs::path& folder) {
  std::map<std::string, json> by_name;
  json runs = json::array();
  for (const auto& run : studies.runs) {
    if (auto result = read_result(folder / (run.name + ".json"))) {
      by_name[run.name] = *result;
      runs.push_back(std::move(*result));
    }
  }
  json summary = {{"profile", studies.profile}, {"runs", runs}, {"series", json::array()}};
  for (const char* quantity : quantities) {
    summary["quantities"][quantity] = {{"relative_u", nullptr}, {"parts", json::object()}};
  }
  for (const auto& series : studies.series) {
    Found found;
    json missing = json::array();
    for (const auto& name : series.runs) {
      if (const auto at = by_name.find(name); at != by_name.end()) {
        found.names.push_back(name);
        found.results.push_back(at->second);
      } else {
        missing.push_back(name);
      }
    }
    json entry = {{"name", series.name},       {"title", series.title}, {"kind", series.kind},
                  {"base", series.base},       {"runs", series.runs},   {"about", series.about},
                  {"counted", series.counted}, {"missing", missing}};
    if (missing.empty()) {
      for (const char* quantity : quantities) {
        const json q = series.kind == "resolution" ? resolution(found, series.base, quantity)
                                                   : spread(found, series.base, quantity);
        entry["quantities"][quantity] = q;
        if (series.counted && series.kind != "physics") {
          summary["quantities"][quantity]["parts"][series.name] = q["relative_u"];
        }
      }
    }
    summary["series"].push_back(std::move(entry));
  }
  for (auto& quantity : summary["quantities"]) {
    double square = 0;
    for (const auto& part : quantity["parts"]) {
      square += std::pow(part.get<double>(), 2);
    }
    if (!quantity["parts"].empty()) {
      quantity["relative_u"] = std::sqrt(square);
    }
  }
  return summary;
}

}  // namespace meltproof::validation

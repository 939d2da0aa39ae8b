// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/studies/summary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "validation/metrics/grid_convergence.hpp"
#include "validation/studies/inputs.hpp"

namespace meltproof::validation {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::array quantities = {"length", "width", "depth"};

/// Nothing where there is no result, or only one of other settings than the run is declared with.
std::optional<json> read_result(const fs::path& path, const std::vector<std::string>& settings) {
  if (!fs::is_regular_file(path)) {
    return std::nullopt;
  }
  const json result = json::parse(read_file(path), nullptr, false);
  if (!result.is_object()) {
    throw InputError(fmt::format("{}: this is no JSON object: remove it and run `make studies`.",
                                 path.string()));
  }
  if (result.contains("settings") && result["settings"] != json(settings)) {
    spdlog::warn(
        "{} was made with {}, but is declared with {}: it does not count; run `make studies`.",
        path.string(), result["settings"].dump(), json(settings).dump());
    return std::nullopt;
  }
  return result;
}

using Found = std::vector<FinishedRun>;

json resolution(const Found& found, const std::string& base, const std::string& quantity) {
  std::array<double, 3> spacing{}, value{};
  std::size_t base_at = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t k = 2 - i;  // declared from coarse to fine
    spacing[i] = result_number(found[k].result, "spacing_um", found[k].declared->name);
    value[i] = result_number(found[k].result, quantity + "_um", found[k].declared->name);
    base_at = found[k].declared->name == base ? i : base_at;
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
  for (const auto& run : found) {
    const std::string& name = run.declared->name;
    const double value = result_number(run.result, quantity + "_um", name);
    if (name == base) {
      at_base = value;
    } else if (result_number(run.result, "clumped_fraction", name) >= clumped_allowed) {
      left_out.push_back(name);
      continue;
    }
    low = first ? value : std::min(low, value);
    high = first ? value : std::max(high, value);
    first = false;
  }
  const double u = (high - low) / (2 * std::sqrt(3.0));
  return {{"u_base_um", u}, {"relative_u", u / at_base}, {"left_out", left_out}};
}

/// What a series says of one quantity, by its kind.
json of_quantity(const StudySeries& series, const Found& found, const std::string& quantity) {
  return series.kind == "resolution" ? resolution(found, series.base, quantity)
         : series.kind == "input"    ? input_effect(series, found, quantity)
                                     : spread(found, series.base, quantity);
}

/// Takes the share of a series into the sums of its quantity, or names it as missing there.
void count(const StudySeries& series, const json& entry, json& summary) {
  for (const char* quantity : quantities) {
    const bool there =
        entry.contains("quantities") && !entry["quantities"][quantity]["relative_u"].is_null();
    if (series.kind == "input") {
      auto& sum = summary["inputs"][quantity];
      if (there) {
        sum["parts"][series.name] = entry["quantities"][quantity]["relative_u"];
        sum["sensitivities"][series.name] = entry["quantities"][quantity]["relative_sensitivity"];
      } else {
        sum["missing"].push_back(series.name);
      }
    } else if (there) {
      summary["quantities"][quantity]["parts"][series.name] =
          entry["quantities"][quantity]["relative_u"];
    }
  }
}

/// relative_u: the root of the sum of squares of the parts; null as long as there is none.
void add_up(json& sums) {
  for (auto& quantity : sums) {
    double square = 0;
    for (const auto& part : quantity["parts"]) {
      square += std::pow(part.get<double>(), 2);
    }
    if (!quantity["parts"].empty()) {
      quantity["relative_u"] = std::sqrt(square);
    }
  }
}

}  // namespace

json summarise(const StudyDeclaration& studies, const fs::path& folder) {
  std::map<std::string, FinishedRun> by_name;
  json runs = json::array();
  for (const auto& run : studies.runs) {
    if (auto result = read_result(folder / (run.name + ".json"), run.set)) {
      // A result keeps the title that it was run with; the declaration's is the one to be read.
      (*result)["title"] = run.title;
      by_name[run.name] = {&run, *result};
      runs.push_back(std::move(*result));
    }
  }
  json summary = {{"profile", studies.profile}, {"runs", runs}, {"series", json::array()}};
  for (const char* quantity : quantities) {
    summary["quantities"][quantity] = {{"relative_u", nullptr}, {"parts", json::object()}};
    summary["inputs"][quantity] = {{"relative_u", nullptr},
                                   {"parts", json::object()},
                                   {"sensitivities", json::object()},
                                   {"missing", json::array()}};
  }
  for (const auto& series : studies.series) {
    Found found;
    json missing = json::array();
    for (const auto& name : series.runs) {
      if (const auto at = by_name.find(name); at != by_name.end()) {
        found.push_back(at->second);
      } else {
        missing.push_back(name);
      }
    }
    json entry = {{"name", series.name},       {"title", series.title}, {"kind", series.kind},
                  {"base", series.base},       {"runs", series.runs},   {"about", series.about},
                  {"counted", series.counted}, {"missing", missing}};
    if (series.kind == "input") {
      entry["input"] = input_facts(series);
    }
    if (missing.empty()) {
      for (const char* quantity : quantities) {
        entry["quantities"][quantity] = of_quantity(series, found, quantity);
      }
    }
    if (series.counted && series.kind != "physics") {
      count(series, entry, summary);
    }
    summary["series"].push_back(std::move(entry));
  }
  add_up(summary["quantities"]);
  add_up(summary["inputs"]);
  return summary;
}

}  // namespace meltproof::validation

// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/linescan/line_comparison.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "base/error.hpp"
#include "validation/eds/interaction_volume.hpp"
#include "validation/linescan/budget.hpp"
#include "validation/linescan/json_numbers.hpp"
#include "validation/linescan/seen_line.hpp"
#include "validation/metrics/area.hpp"

namespace meltproof::validation {
namespace {

using nlohmann::json;

/// @param u of the differences; empty, or with a zero, leaves the reduced chi-square out
json metrics_json(const std::vector<double>& simulated, const std::vector<double>& measured,
                  std::vector<double> u, std::size_t fitted) {
  if (std::any_of(u.begin(), u.end(), [](double value) { return !(value > 0); })) {
    u.clear();
  }
  const CurveMetrics m = curve_metrics(simulated, measured, u, fitted);
  return {{"points", m.points},
          {"E", m.bias},
          {"RMSE", m.root_mean_square},
          {"MAE", m.mean_absolute},
          {"max_deviation", m.maximum_deviation},
          {"R2", number_json(m.r_squared)},
          {"reduced_chi_square", number_json(m.reduced_chi_square)},
          {"area", area_metric(simulated, measured)}};
}

json grain_json(const Grain& grain) {
  return {{"centre_um", micrometres_json(grain.centre)},
          {"particles", grain.particles},
          {"melted_share", grain.melted},
          {"edge_distance_um", 1e6 * grain.edge_distance()},
          {"pool_edges_y_um", {1e6 * grain.edge_low, 1e6 * grain.edge_high}},
          {"rule",
           "of the additive grains of which at least half melted, the one nearest to the "
           "lateral edge of the molten zone"}};
}

json interaction_json(const LineRequest& request, const SeenLine& line) {
  const auto [narrow, wide] = std::minmax_element(line.sigma.begin(), line.sigma.end());
  const char* matrix = request.sigma                     ? "given"
                       : request.matrix == Matrix::local ? "local"
                       : request.matrix == Matrix::iron  ? "iron"
                                                         : "aluminium";
  return {{"voltage_kV", request.voltage},
          {"element", line.element},
          {"edge_keV", line.edge},
          {"range_um", 1e6 * line.range},
          {"sigma_um", 1e6 * line.sigma_in_iron},
          {"matrix", matrix},
          {"sigma_least_um", 1e6 * *narrow},
          {"sigma_most_um", 1e6 * *wide},
          {"electron_range_iron_um", 1e6 * kanaya_okayama_range(iron, request.voltage)},
          {"electron_range_aluminium_um", 1e6 * kanaya_okayama_range(aluminium, request.voltage)},
          {"rule", request.sigma
                       ? "given"
                       : fmt::format("full width at half maximum = range of {}-K X-rays in {} "
                                     "(Anderson and Hasler)",
                                     line.element,
                                     request.matrix == Matrix::local ? "the matrix at each point"
                                                                     : matrix)}};
}

/// A list along the simulated line at other places on it; between points in proportion.
std::vector<double> at_places(const std::vector<double>& position,
                              const std::vector<double>& values,
                              const std::vector<double>& places) {
  std::vector<double> result;
  for (const double place : places) {
    const auto above = std::upper_bound(position.begin(), position.end(), place);
    const auto i = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(above - position.begin(), 1, std::ssize(position) - 1));
    const double part =
        std::clamp((place - position[i - 1]) / (position[i] - position[i - 1]), 0.0, 1.0);
    result.push_back(values[i - 1] + part * (values[i] - values[i - 1]));
  }
  return result;
}

std::vector<double> picked(const std::vector<double>& values,
                           const std::vector<std::size_t>& index) {
  std::vector<double> result;
  for (const std::size_t i : index) {
    if (!values.empty()) {
      result.push_back(values[i]);
    }
  }
  return result;
}

json root_mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) {
    sum += value * value / static_cast<double>(values.size());
  }
  return values.empty() ? json() : json(std::sqrt(sum));
}

void add_uncertainty(json& result, const LineRequest& request, const LineBudget& budget,
                     const Registration& r) {
  const auto total = budget.total();
  double level = 0;
  for (const double value : r.measured) {
    level += value / static_cast<double>(r.measured.size());
  }
  ComparisonUncertainty parts;
  const auto v = line_validation_error(r.after.bias, level, budget, request.systematic,
                                       request.coverage, parts);
  result["uncertainty"] = {
      {"rms_reported", root_mean_square(budget.reported)},
      {"rms_counting", root_mean_square(budget.counting)},
      {"rms_strip", root_mean_square(budget.strip)},
      {"rms_numerical", root_mean_square(budget.numerical)},
      {"rms_total", root_mean_square(total)},
      {"numerical_rule",
       request.numerical ? "given" : "slope of the seen profile times spacing / sqrt(12)"},
      {"measured_rule", "the larger of the reported sigma and the noise of the counts"}};
  result["vv20"] = {{"E", v.error},
                    {"u_num", number_json(parts.numerical)},
                    {"u_input", number_json(parts.input)},
                    {"u_D", number_json(parts.data)},
                    {"u_val", v.uncertainty},
                    {"coverage", request.coverage},
                    {"lower", v.lower},
                    {"upper", v.upper},
                    {"within", v.within()},
                    {"complete", v.complete},
                    {"quantity", "mean difference over the compared points"}};
  result["metrics"] = metrics_json(r.simulated, r.measured, total, r.fitted);
  result["metrics_before"] = metrics_json(r.simulated_before, r.measured, total, 0);
  result["compared"]["u"] = filled_json(total, r.position.size());
}

void add_measured(json& result, const LineRequest& request, const SeenLine& line,
                  std::vector<Warning>& warnings) {
  MeasuredRequest wanted{request.measured, request.options,    request.from,
                         request.base,     request.base_given, request.voltage};
  const MeasuredLine m = read_measured_line(wanted);
  if (m.scan.empty_slot) {
    result["pending_because"] =
        fmt::format("{} is an empty slot: it holds no point yet", request.measured.string());
    return;
  }
  warnings.insert(warnings.end(), m.warnings.begin(), m.warnings.end());
  const auto& position = m.profile.position;
  const double length = position.back() - position.front();
  if (length < line.largest_range) {
    warnings.push_back(
        {"shorter_than_interaction_volume",
         fmt::format(
             "{}: the scan of {:.3g} um is shorter than the {:.3g} um that {}-K X-rays come "
             "from at {} kV: it cannot show a profile.",
             request.measured.string(), 1e6 * length, 1e6 * line.largest_range, line.element,
             request.voltage)});
  }
  const auto r = register_profiles(line.strip.position, line.seen, position,
                                   m.profile.concentration, {}, m.scan.flagged, request.bounds);
  const bool stated = m.scan.alloy.has_value();
  const char* from = stated                                ? "stated"
                     : request.from == Estimate::aluminium ? "Al"
                     : request.from == Estimate::silicon   ? "Si"
                                                           : "least_squares";
  result["status"] = "compared";
  result["measured"] = {
      {"file", request.measured.string()},
      {"format", m.scan.format},
      {"position_um", micrometres_json(position)},
      {"concentration", numbers_json(m.profile.concentration)},
      {"concentration_u", filled_json(m.profile.uncertainty, position.size())},
      {"concentration_u_counting", filled_json(m.profile.counting, position.size())},
      {"total", numbers_json(m.scan.total)},
      {"flagged_points", m.scan.flagged},
      {"from", from},
      {"estimates", m.estimates},
      {"agreement", m.agreement}};
  json residual = json::array();
  for (std::size_t i = 0; i < r.simulated.size(); ++i) {
    residual.push_back(r.simulated[i] - r.measured[i]);
  }
  result["compared"] = {{"position_um", micrometres_json(r.position)},
                        {"simulated", numbers_json(r.simulated)},
                        {"measured", numbers_json(r.measured)},
                        {"residual", residual},
                        {"place_on_simulated_line_um", micrometres_json(r.place)}};
  const bool at_bound =
      !r.by_landmark && request.bounds.shift > 0 && std::abs(r.shift) > 0.99 * request.bounds.shift;
  result["registration"] = {{"shift_um", 1e6 * r.shift},
                            {"largest_shift_um", 1e6 * request.bounds.shift},
                            {"reversed", r.reversed},
                            {"fitted_parameters", r.fitted},
                            {"by", r.by_landmark              ? "landmark"
                                   : request.bounds.shift > 0 ? "smallest RMSE"
                                                              : "none"},
                            {"at_bound", at_bound}};
  if (at_bound) {
    warnings.push_back({"at_bound", fmt::format("{}: the shift of {:.3g} um lies at its bound: the "
                                                "origins may be further apart than allowed.",
                                                request.measured.string(), 1e6 * r.shift)});
  }
  LineBudget budget;
  budget.reported = picked(m.profile.uncertainty, r.index);
  budget.counting = picked(m.profile.counting, r.index);
  budget.strip = at_places(line.strip.position, line.u_strip, r.place);
  budget.numerical = at_places(line.strip.position, line.u_spacing, r.place);
  add_uncertainty(result, request, budget, r);
}

}  // namespace

json compare_line(const LineRequest& request) {
  const SolidifiedTrack track = read_solidified_track(request.run);
  json result;
  Point start = request.start, end = request.end;
  result["grain"] = json();
  if (request.grain) {
    const auto grain = grain_at_pool_edge(track);
    if (!grain) {
      throw NoGrain(fmt::format(
          "{}: no grain of the additive melted, so there is no line through one; name a line with "
          "--start and --end instead.",
          request.run.string()));
    }
    start = grain->centre;
    end = line_end(*grain, *request.grain, request.length);
    result["grain"] = grain_json(*grain);
  }
  const SeenLine line = see_line(track, request, start, end);
  std::vector<Warning> warnings;
  const double length = line.strip.position.back();
  const bool resolved = track.spacing <= 0.1 * length;
  if (!resolved) {
    warnings.push_back(
        {"spacing",
         fmt::format("{}: the spacing of {:.3g} um is coarse for a line of {:.3g} um: the profile "
                     "shows the spacing rather than the mixing",
                     request.run.string(), 1e6 * track.spacing, 1e6 * length)});
  }
  const auto [shallow, deep] =
      std::minmax_element(line.strip.depth.begin(), line.strip.depth.end());
  result["line"] = {{"start_um", micrometres_json(start)},
                    {"end_um", micrometres_json(end)},
                    {"direction", !request.grain                       ? "given"
                                  : *request.grain == Direction::depth ? "depth"
                                                                       : "lateral"},
                    {"time_us", 1e6 * track.time},
                    {"resolved", resolved},
                    {"spacing_um", 1e6 * track.spacing},
                    {"strip",
                     {{"width_um", 1e6 * request.width},
                      {"least_depth_um", 1e6 * *shallow},
                      {"most_depth_um", 1e6 * *deep},
                      {"beam", line.beam},
                      {"samples", line.strip.samples}}}};
  result["interaction"] = interaction_json(request, line);
  result["simulated"] = {{"position_um", micrometres_json(line.strip.position)},
                         {"concentration", numbers_json(line.strip.on_line)},
                         {"concentration_strip", numbers_json(line.strip.mean)},
                         {"concentration_strip_sd", numbers_json(line.strip.scatter)},
                         {"concentration_seen", numbers_json(line.seen)},
                         {"u_strip", numbers_json(line.u_strip)},
                         {"u_numerical", numbers_json(line.u_spacing)},
                         {"interaction_sigma_um", micrometres_json(line.sigma)}};
  result["status"] = "pending";
  for (const char* key : {"measured", "compared", "metrics", "metrics_before", "registration",
                          "uncertainty", "vv20"}) {
    result[key] = json();
  }
  if (!request.measured.empty()) {
    add_measured(result, request, line, warnings);
  }
  result["warnings"] = json::array();
  for (const auto& warning : warnings) {
    spdlog::warn("{}", warning.sentence);
    result["warnings"].push_back({{"name", warning.name}, {"sentence", warning.sentence}});
  }
  return result;
}

}  // namespace meltproof::validation

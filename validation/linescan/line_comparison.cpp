// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/linescan/line_comparison.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "validation/eds/interaction_volume.hpp"
#include "validation/eds/line_scan.hpp"

namespace meltproof::validation {
namespace {

using nlohmann::json;

/// Lengths of a result in um; a place without material is null.
json micrometres(std::span<const double> lengths) {
  json list = json::array();
  for (const double length : lengths) {
    list.push_back(1e6 * length);
  }
  return list;
}

json numbers(std::span<const double> values) {
  json list = json::array();
  for (const double value : values) {
    list.push_back(std::isnan(value) ? json() : json(value));
  }
  return list;
}

json optional(const std::optional<double>& value) { return value ? json(*value) : json(); }

json metrics_json(const CurveMetrics& m) {
  return {{"points", m.points},
          {"E", m.bias},
          {"RMSE", m.root_mean_square},
          {"MAE", m.mean_absolute},
          {"max_deviation", m.maximum_deviation},
          {"R2", optional(m.r_squared)},
          {"reduced_chi_square", optional(m.reduced_chi_square)}};
}

json grain_json(const Grain& grain) {
  return {{"centre_um", micrometres(grain.centre)},
          {"particles", grain.particles},
          {"melted_share", grain.melted},
          {"edge_distance_um", 1e6 * grain.edge_distance()},
          {"pool_edges_y_um", {1e6 * grain.edge_low, 1e6 * grain.edge_high}},
          {"rule",
           "of the additive grains of which at least half melted, the one nearest to the "
           "lateral edge of the molten zone"}};
}

struct Measured {
  LineScan scan;
  ConcentrationProfile profile;
};

Measured read_measured(const LineRequest& request) {
  Measured measured;
  measured.scan = read_line_scan(request.measured);
  measured.profile = request.from_silicon
                         ? concentration_from_silicon(measured.scan, request.silicon_of_base)
                         : concentration_from_aluminium(measured.scan);
  auto& u = measured.profile.uncertainty;
  if (std::any_of(u.begin(), u.end(), [](double value) { return !(value > 0); })) {
    spdlog::warn(
        "{}: some uncertainties are zero, so none is used: the reduced chi-square is left out",
        request.measured.string());
    u.clear();
  }
  if (!measured.scan.flagged.empty()) {
    spdlog::warn("{}: {} of {} points have a total outside 95 to 105 %: they are not compared",
                 request.measured.string(), measured.scan.flagged.size(),
                 measured.scan.position.size());
  }
  return measured;
}

void add_measured(json& result, const LineRequest& request, const SimulatedProfile& line,
                  std::span<const double> seen) {
  const Measured m = read_measured(request);
  const auto r = register_profiles(line.position, seen, m.profile.position, m.profile.concentration,
                                   m.profile.uncertainty, m.scan.flagged, request.bounds);
  json u = numbers(m.profile.uncertainty);
  if (u.empty()) {
    u = json(m.profile.position.size(), json());
  }
  result["status"] = "compared";
  result["measured"] = {{"file", request.measured.string()},
                        {"position_um", micrometres(m.profile.position)},
                        {"concentration", numbers(m.profile.concentration)},
                        {"concentration_u", u},
                        {"total", numbers(m.scan.total)},
                        {"flagged_points", m.scan.flagged},
                        {"from", request.from_silicon ? "Si" : "Al"}};
  result["compared"] = {{"position_um", micrometres(r.position)},
                        {"simulated", numbers(r.simulated)},
                        {"measured", numbers(r.measured)}};
  result["metrics"] = metrics_json(r.after);
  result["metrics_before"] = metrics_json(r.before);
  result["registration"] = {
      {"shift_um", 1e6 * r.shift},
      {"largest_shift_um", 1e6 * request.bounds.shift},
      {"reversed", r.reversed},
      {"fitted_parameters", r.fitted},
      {"at_bound", request.bounds.shift > 0 && std::abs(r.shift) > 0.99 * request.bounds.shift}};
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
  const auto line = sample_line(track, start, end, request.step);
  const double range = anderson_hasler_range(iron.density, request.voltage, aluminium_k_edge);
  const double sigma = request.sigma.value_or(interaction_sigma(range));
  const auto seen =
      convolve_gaussian(line.concentration, line.position[1] - line.position[0], sigma);
  const double length = line.position.back();
  const bool resolved = track.spacing <= 0.1 * length;
  if (!resolved) {
    spdlog::warn(
        "{}: the spacing of {:.3g} um is coarse for a line of {:.3g} um: the profile shows the "
        "spacing rather than the mixing",
        request.run.string(), 1e6 * track.spacing, 1e6 * length);
  }
  result["line"] = {{"start_um", micrometres(start)},
                    {"end_um", micrometres(end)},
                    {"direction", !request.grain                       ? "given"
                                  : *request.grain == Direction::depth ? "depth"
                                                                       : "lateral"},
                    {"time_us", 1e6 * track.time},
                    {"resolved", resolved},
                    {"spacing_um", 1e6 * track.spacing}};
  result["interaction"] = {
      {"voltage_kV", request.voltage},
      {"range_um", 1e6 * range},
      {"sigma_um", 1e6 * sigma},
      {"rule", request.sigma ? "given"
                             : "full width at half maximum = range of Al-K X-rays in iron "
                               "(Anderson and Hasler)"}};
  result["simulated"] = {{"position_um", micrometres(line.position)},
                         {"concentration", numbers(line.concentration)},
                         {"concentration_seen", numbers(seen)}};
  result["status"] = "pending";
  result["measured"] = result["compared"] = result["metrics"] = json();
  result["metrics_before"] = result["registration"] = json();
  if (!request.measured.empty()) {
    add_measured(result, request, line, seen);
  }
  return result;
}

}  // namespace meltproof::validation

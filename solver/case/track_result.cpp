// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/case/track_result.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace meltproof::solver {
namespace {

nlohmann::json window_json(const std::vector<HistoryLine>& lines, const TrackCase& t,
                           nlohmann::json result) {
  const double from = std::max(0.0, t.exposure - t.averaging_window);
  const auto add = [&](const std::string& key, double (*quantity)(const HistoryLine&)) {
    const WindowMean w = window_mean(lines, from, t.exposure, quantity);
    result[key + "_um"] = 1e6 * w.mean;
    result[key + "_sd_um"] = 1e6 * w.deviation;
    result[key + "_growth_um_per_ms"] = 1e3 * w.growth;
  };
  add("pool_length", [](const HistoryLine& l) { return l.pool.length; });
  add("pool_width", [](const HistoryLine& l) { return l.pool.width; });
  add("pool_depth", [](const HistoryLine& l) { return l.pool.depth; });
  add("any_liquid_length", [](const HistoryLine& l) { return l.any_liquid.length; });
  result["window"] =
      fmt::format("mean over {:.0f} to {:.0f} us, the last {:.0f} us of the exposure", 1e6 * from,
                  1e6 * t.exposure, 1e6 * (t.exposure - from));
  return result;
}

/// Width and depth of what was ever above the liquidus, between 40 and 80 % of the track, where
/// neither its start nor its end counts: what a section through the solidified track shows.
void add_fusion_zone(nlohmann::json& result, const TrackCase& t, const Mixture& mixture,
                     const Particles& p) {
  std::vector<double> level(p.size());
  const double track = t.speed * t.exposure;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double x = p.position[i][0];
    const bool middle = x > 0.4 * track && x < 0.8 * track;
    // Infinitely far below, so that the cut itself makes no crossing between particles.
    level[i] = middle ? p.peak_temperature[i] - mixture.liquidus(0)
                      : -std::numeric_limits<double>::infinity();
  }
  const Extent zone = measure_extent(p, pack_neighbours(p, {}, touching * p.spacing), level, true);
  result["fusion_width_um"] = 1e6 * zone.width;
  result["fusion_depth_um"] = 1e6 * zone.depth;
}

}  // namespace

double clumped_in_window(const TrackCase& t, const std::vector<HistoryLine>& lines) {
  return window_mean(lines, std::max(0.0, t.exposure - t.averaging_window), t.exposure,
                     [](const HistoryLine& l) { return l.clumped; })
      .mean;
}

double pool_isotherm(const TrackCase& t, const Mixture& mixture) {
  return t.pool_temperature > 0 ? t.pool_temperature : mixture.liquidus(0);
}

/// Whether this rank has any.
bool melt_left_here(const Engine& engine) {
  const Particles& p = engine.particles();
  const PackedLists& list = engine.neighbours();
  const double touch = 2.25 * p.spacing * p.spacing;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const bool molten =
        p.home[i] == Home::here &&
        (engine.model().flow ? p.phase[i] == Phase::liquid : p.liquid_fraction[i] >= 1);
    const auto touches = [&](std::uint32_t j) {
      if (j >= p.size() || p.phase[j] != Phase::solid) {
        return false;
      }
      const auto &a = p.position[i], &b = p.position[j];
      const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
      return x * x + y * y + z * z < touch;
    };
    if (molten && list.any(i, touches)) {
      return true;
    }
  }
  return false;
}

bool melt_left(const Engine& engine) { return engine.ranks().any(melt_left_here(engine)); }

Timings step_timings(const Engine& engine) {
  const StepTimes& w = engine.times();
  return {{"heat", w.heat},   {"species", w.species}, {"surface", w.surface},
          {"state", w.state}, {"lists", w.lists},     {"flow", w.flow}};
}

nlohmann::json track_result(const TrackCase& t, const Discretisation& made, const Engine& engine,
                            const RunProgress& run, const Particles& whole,
                            const Acceptance& acceptance) {
  const double reference = pool_isotherm(t, engine.mixture());
  const HistoryLine final = measure(engine, reference, run.start_enthalpy);
  const EnergyLedger& ledger = engine.ledger();
  nlohmann::json result = {
      {"title", t.title},
      {"spacing_um", 1e6 * t.spacing},
      {"particles", whole.size()},
      {"additive_wt_percent", 100 * made.bed_additive_mass_fraction},
      {"additive_wt_percent_as_particles", 100 * made.additive_mass_fraction},
      {"powder_volume_relative_error", made.powder_volume_error},
      {"reference_temperature_K", reference},
      {"energy_absorbed_J", ledger.absorbed},
      {"energy_reflected_J", ledger.reflected},
      {"energy_missed_J", ledger.missed},
      {"energy_evaporated_J", ledger.evaporated},
      {"energy_radiated_J", ledger.radiated},
      {"enthalpy_change_J", final.enthalpy_change},
      {"energy_relative_error",
       std::abs(final.absorbed - final.lost - final.enthalpy_change) / final.absorbed},
      {"beam_balance_relative_error", run.beam_balance},
      {"species_relative_error",
       run.start_additive > 0 ? std::abs(engine.total_additive_mass() / run.start_additive - 1)
                              : 0.0},
      {"all_solid_at_end", !melt_left(engine)},
      {"steps", engine.steps()},
      {"time_step_held_by", engine.limits().smallest_name()},
      {"end_time_us", 1e6 * engine.time()},
      {"snapshots", run.snapshots}};
  result = window_json(run.lines, t, std::move(result));
  if (engine.model().flow) {
    const LimiterCounts acted = engine.limiters();
    result["limiters"] = {{"wall_pressure_clipped", acted.wall_pressure},
                          {"wall_particle_steps", acted.wall_steps},
                          {"curvature_held", acted.curvature},
                          {"liquid_particle_steps", acted.particle_steps}};
  }
  const double track = t.speed * t.exposure;
  result["steady_state"] = steadiness_json(run.lines, start_up_length(track) / t.speed, t.exposure);
  result["steady"] = result["steady_state"]["pool_length"]["sentence"];
  add_fusion_zone(result, t, engine.mixture(), whole);
  result["acceptance"] = acceptance.json();
  result["timings"] = timings_json(step_timings(engine));
  result["wall_time_s"] = run.wall_time;
  result["particle_steps_per_second"] =
      static_cast<double>(engine.steps()) * static_cast<double>(whole.size()) / run.wall_time;
  result["revision"] = code_revision();
  return result;
}

}  // namespace meltproof::solver

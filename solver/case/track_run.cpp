// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/case/track_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "base/artifact.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/progress.hpp"
#include "solver/output/history.hpp"
#include "solver/output/paraview.hpp"
#include "solver/output/run_summary.hpp"
#include "solver/output/snapshot.hpp"

namespace meltproof::solver {
namespace {

Mixture read_mixture(const TrackCase& t) {
  const Form form = t.form == "as_printed" ? Form::as_printed : Form::repaired;
  Material base = read_material(t.base, form);
  if (t.absorptivity >= 0) {
    base.absorptivity = t.absorptivity;
  }
  Material additive = read_material(t.additive, form);
  if (t.density == "own") {
    base.density = base.real_density;
    additive.density = additive.real_density;
  }
  return {base, additive};
}

double pool_isotherm(const TrackCase& t, const Mixture& mixture) {
  return t.pool_temperature > 0 ? t.pool_temperature : mixture.liquidus(0);
}

void write_facts(ArtifactWriter& writer, const TrackCase& t, const Engine& engine,
                 const Discretisation& made) {
  writer.attribute("title", t.title);
  writer.write("spacing", t.spacing, "m", "particle spacing");
  writer.write("smoothing_length", engine.kernel().smoothing_length, "m",
               "of the quintic spline, support 3 h");
  writer.write("scan_speed", t.speed, "m s-1", "of the beam along x");
  writer.write("laser_power", t.power, "W", "of the beam");
  writer.write("beam_radius", t.beam_radius, "m", "1/e2 radius");
  writer.write("exposure", t.exposure, "s", "the beam is on from 0 to here");
  writer.write("additive_mass_fraction", made.bed_additive_mass_fraction, "1",
               "of the powder blend as spheres");
  writer.write("reference_temperature", pool_isotherm(t, engine.mixture()), "K",
               "outlines the melt pool");
  writer.write("initial_temperature", t.initial_temperature, "K", "of plate and powder");
  writer.write("domain/lower", std::span<const double>(made.domain.lower), {3}, "m",
               "lower corner of the domain");
  writer.write("domain/upper", std::span<const double>(made.domain.upper), {3}, "m",
               "upper corner of the domain");
}

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
void add_fusion_zone(nlohmann::json& result, const TrackCase& t, const Engine& engine) {
  const Particles& p = engine.particles();
  std::vector<double> level(p.size());
  const double track = t.speed * t.exposure;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double x = p.position[i][0];
    const bool middle = x > 0.4 * track && x < 0.8 * track;
    // Infinitely far below, so that the cut itself makes no crossing between particles.
    level[i] = middle ? p.peak_temperature[i] - engine.mixture().liquidus(0)
                      : -std::numeric_limits<double>::infinity();
  }
  const Extent zone = measure_extent(p, engine.neighbours(), level, true);
  result["fusion_width_um"] = 1e6 * zone.width;
  result["fusion_depth_um"] = 1e6 * zone.depth;
}

/// Whether any melt still lies on solid metal; a drop in flight has nothing to freeze to.
bool melt_left(const Engine& engine) {
  const Particles& p = engine.particles();
  const NeighbourList& list = engine.neighbours();
  const double touch = 2.25 * p.spacing * p.spacing;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const bool molten =
        engine.model().flow ? p.phase[i] == Phase::liquid : p.liquid_fraction[i] >= 1;
    for (std::size_t k = list.first[i]; molten && k < list.last[i]; ++k) {
      const std::uint32_t j = list.index[k];
      if (j < p.size() && p.phase[j] == Phase::solid) {
        const auto &a = p.position[i], &b = p.position[j];
        const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
        if (x * x + y * y + z * z < touch) {
          return true;
        }
      }
    }
  }
  return false;
}

}  // namespace

nlohmann::json run_track(const TrackCase& t, const std::string& name,
                         const std::filesystem::path& folder, Provenance provenance, bool quiet) {
  const Mixture mixture = read_mixture(t);
  for (const auto& sentence : warnings(t, mixture)) {
    spdlog::warn("{}", sentence);
  }
  Discretisation made = discretise(t, mixture);
  Engine engine(made.particles, mixture, read_diffusivity(t.diffusivity_laws, t.diffusivity_law),
                make_model(t, made.domain));
  made.particles = {};
  spdlog::info(
      "{}: {} particles, spacing {:.3g} um, {:.1f} neighbours each, domain {:.0f} x {:.0f} x "
      "{:.0f} um",
      name, engine.particles().size(), 1e6 * t.spacing, engine.neighbours().mean_neighbours(),
      1e6 * (made.domain.upper[0] - made.domain.lower[0]),
      1e6 * (made.domain.upper[1] - made.domain.lower[1]),
      1e6 * (made.domain.upper[2] - made.domain.lower[2]));

  ArtifactWriter writer(folder / "run.h5", "meltproof run");
  write_facts(writer, t, engine, made);
  const double reference = pool_isotherm(t, mixture), start_enthalpy = engine.total_enthalpy(),
               start_additive = engine.total_additive_mass();
  std::vector<HistoryLine> lines{measure(engine, reference, start_enthalpy)};
  std::size_t snapshots = 0, history = 1;
  write_snapshot(writer, snapshots++, engine);
  const double end = t.exposure + t.cooling_limit;
  const AcceptanceSettings judged = track_acceptance(made.domain.lower, made.domain.upper,
                                                     t.speed * t.exposure, t.beam_radius);
  // At the end all is solid: how the melt fared is measured as the beam goes off.
  Acceptance melt;
  double beam_balance = 0;
  {
    Progress progress(name, t.exposure);
    while (engine.time() < end) {
      const double next_line = static_cast<double>(history) * t.history_interval;
      const double next_frame = static_cast<double>(snapshots) / t.frame_rate;
      double until = std::min({next_line, end, next_frame < t.exposure ? next_frame : end});
      until = engine.time() < t.exposure ? std::min(until, t.exposure) : until;
      double dt = 0;
      while (engine.time() < until) {
        dt = engine.step(until);
        const LaserBudget& beam = engine.beam();
        if (engine.time() <= t.exposure) {
          beam_balance =
              std::max(beam_balance,
                       std::abs(beam.absorbed + beam.reflected + beam.missed - t.power) / t.power);
        }
      }
      if (engine.time() == next_line || engine.time() == t.exposure) {
        lines.push_back(measure(engine, reference, start_enthalpy));
        lines.back().step = dt;
        history += engine.time() == next_line ? 1 : 0;
        const auto& now = lines.back();
        if (!quiet) {
          progress.update(
              std::min(engine.time(), t.exposure),
              fmt::format("step {}, t {:.1f} us, dt {:.3f} us, pool {:.0f} um, peak {:.0f} K",
                          engine.steps(), 1e6 * now.time, 1e6 * dt, 1e6 * now.pool.length,
                          now.peak_temperature));
        }
        if (engine.time() == t.exposure) {
          melt = measure_acceptance(engine.particles(), judged);
        }
        if (engine.time() > t.exposure && !melt_left(engine) &&
            (engine.model().flow || (!now.pool.found && !now.any_liquid.found))) {
          break;
        }
      }
      if (engine.time() == next_frame && next_frame < t.exposure) {
        write_snapshot(writer, snapshots++, engine);
      }
    }
  }
  const StepTimes& w = engine.times();
  spdlog::info(
      "{} thermal and {} flow steps, {} list builds; seconds: heat {:.1f}, species {:.1f}, surface "
      "{:.1f}, state {:.1f}, lists {:.1f}, flow {:.1f}",
      engine.steps(), engine.flow_steps(), engine.list_builds(), w.heat, w.species, w.surface,
      w.state, w.lists, w.flow);
  // The last snapshot is the solidified track.
  write_snapshot(writer, snapshots++, engine);

  const HistoryLine final = measure(engine, reference, start_enthalpy);
  const EnergyLedger& ledger = engine.ledger();
  nlohmann::json result = {
      {"case", name},
      {"title", t.title},
      {"spacing_um", 1e6 * t.spacing},
      {"particles", engine.particles().size()},
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
      {"beam_balance_relative_error", beam_balance},
      {"species_relative_error",
       start_additive > 0 ? std::abs(engine.total_additive_mass() / start_additive - 1) : 0.0},
      {"all_solid_at_end", !melt_left(engine)},
      {"steps", engine.steps()},
      {"time_step_held_by", engine.limits().smallest_name()},
      {"end_time_us", 1e6 * engine.time()},
      {"snapshots", snapshots}};
  result = window_json(lines, t, std::move(result));
  if (engine.model().flow) {
    const LimiterCounts& acted = engine.flow().limiters();
    result["limiters"] = {{"wall_pressure_clipped", acted.wall_pressure},
                          {"wall_particle_steps", acted.wall_steps},
                          {"curvature_held", acted.curvature},
                          {"liquid_particle_steps", acted.particle_steps}};
  }
  const double track = t.speed * t.exposure;
  result["steady_state"] = steadiness_json(lines, start_up_length(track) / t.speed, t.exposure);
  result["steady"] = result["steady_state"]["pool_length"]["sentence"];
  add_fusion_zone(result, t, engine);
  Acceptance acceptance = measure_acceptance(engine.particles(), judged);
  acceptance.liquid = melt.liquid;
  acceptance.liquid_volume = melt.liquid_volume;
  result["acceptance"] = acceptance.json();
  const Timings timings{{"heat", w.heat},   {"species", w.species}, {"surface", w.surface},
                        {"state", w.state}, {"lists", w.lists},     {"flow", w.flow}};
  result["timings"] = timings_json(timings);
  provenance.wall_time = provenance.elapsed();
  result["wall_time_s"] = provenance.wall_time;
  result["particle_steps_per_second"] = static_cast<double>(engine.steps()) *
                                        static_cast<double>(engine.particles().size()) /
                                        provenance.wall_time;
  result["revision"] = code_revision();
  result["provenance"] = provenance.json();
  writer.commit(provenance);
  write_xdmf(folder / "run.h5");
  write_file(folder / "history.csv", history_csv(lines));
  write_file(folder / "input.toml", provenance.resolved_input);
  write_file(folder / "result.json", result.dump(2) + "\n");
  if (!quiet) {
    print_run_summary(result, acceptance, timings, provenance, folder);
  }
  return result;
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include <chrono>

#include <fmt/format.h>

#include "base/progress.hpp"
#include "solver/bench/stages.hpp"
#include "solver/case/track_result.hpp"

namespace meltproof::solver {
namespace {

double seconds_since(std::chrono::steady_clock::time_point begun) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

/// An engine that is timed window by window.
struct Timed {
  Engine engine;
  std::vector<double> seconds;  ///< per window, with the share of a full sort that falls to it
  std::vector<double> steps;    ///< acoustic, per window
  std::vector<double> thermal_steps;  ///< per window
  std::vector<double> melt_steps;     ///< acoustic steps times liquid particles, per window
  std::vector<double> flow_seconds;   ///< of those in the passes of the flow
  Timings before;

  Timed(EngineState state, const DevelopedPool& pool, const Model& model)
      : engine(std::move(state), pool.mixture, pool.diffusivity, model),
        before(step_timings(engine)) {}

  void advance(double window, double seconds_per_list_build) {
    const std::size_t acoustic = engine.flow_steps(), thermal = engine.steps(),
                      builds = engine.list_builds();
    const auto melt = engine.flow().limiters().particle_steps;
    const double until = engine.time() + window, flow = engine.times().flow;
    const auto begun = std::chrono::steady_clock::now();
    while (engine.time() < until) {
      engine.step(until);
    }
    seconds.push_back(seconds_since(begun) +
                      static_cast<double>(engine.list_builds() - builds) * seconds_per_list_build);
    steps.push_back(static_cast<double>(engine.flow_steps() - acoustic));
    thermal_steps.push_back(static_cast<double>(engine.steps() - thermal));
    melt_steps.push_back(static_cast<double>(engine.flow().limiters().particle_steps - melt));
    flow_seconds.push_back(engine.times().flow - flow);
  }

  nlohmann::json details() const {
    nlohmann::json shares, parts;
    double total = 0;
    const Timings now = step_timings(engine);
    for (std::size_t p = 0; p < now.size(); ++p) {
      total += now[p].second - before[p].second;
    }
    for (std::size_t p = 0; p < now.size(); ++p) {
      shares[now[p].first] = (now[p].second - before[p].second) / total;
    }
    return {{"seconds", seconds},
            {"acoustic_steps", steps},
            {"thermal_steps", thermal_steps},
            {"share_of_time", shares}};
  }
};

/// What a full sort costs each time lists are made: the engine sorts once in some 256 of them, more
/// rarely than once in what is timed here.
double sort_seconds_per_build(const DevelopedPool& pool) {
  Particles particles = pool.state.particles;
  const auto begun = std::chrono::steady_clock::now();
  sort_in_space(particles, 3 * pool.model.smoothing_ratio * particles.spacing);
  return seconds_since(begun) / 256;
}

}  // namespace

NothingSkipped skip_nothing(const DevelopedPool& pool) {
  NothingSkipped all{pool.model, pool.state};
  all.model.sleep_below = 0;
  // With sleep at zero whoever still has the start's temperature to the last bit would sleep on; of
  // a start without sleep the engine says that no temperature is the start's.
  all.state.start_temperature = -1e9;
  all.model.flow_steps = 1;
  all.model.multirate = false;
  all.model.keep_lists = false;
  return all;
}

StageResult whole_step_stage(const DevelopedPool& pool, const BenchSettings& settings) {
  EngineState begin = pool.state;
  // A full sort may or may not fall into what is timed; it is charged by its share instead.
  begin.builds_since_sort = 0;
  const double sorting = sort_seconds_per_build(pool);
  NothingSkipped all = skip_nothing(pool);
  all.state.builds_since_sort = 0;
  Model everywhere = all.model;
  everywhere.flow->walls_everywhere = true;
  Timed tracks(std::move(begin), pool, pool.model), concerned(all.state, pool, all.model),
      everything(std::move(all.state), pool, everywhere);
  {
    Progress progress("whole steps", settings.repeats);
    for (int repeat = 0; repeat < settings.repeats; ++repeat) {
      tracks.advance(settings.window, sorting);
      progress.update(repeat + 0.1, "as tracks run");
      concerned.advance(settings.window, sorting);
      progress.update(repeat + 0.5, "nothing skipped");
      everything.advance(settings.window, sorting);
      progress.update(repeat + 1, "passes of walls for all solid, too");
    }
  }
  const auto particles = static_cast<double>(pool.state.particles.size());
  Figure rate{"whole_step_Mupd_per_core",
              "1e6 particle steps per second and core",
              "all particles times acoustic steps over wall-clock time, one thread, developed "
              "pool, active sets and multirate off; lists, sorting and integration included",
              {}};
  Figure speedup{
      "active_set_speedup",
      "1",
      "wall-clock time of the same simulated time with everything computed in every step "
      "(active sets, kept lists and multirate off, passes of walls for all solid), over "
      "that as tracks run; one thread, in turns",
      {}};
  Figure beside_melt{
      "active_set_speedup_walls_beside_melt",
      "1",
      "the same, but that the passes of walls concern in both only the solid that has "
      "melt in reach",
      {}};
  Figure flow{"flow_Mupd_per_core",
              "1e6 particle steps per second and core",
              "liquid particles times acoustic steps over the time in the passes of the flow "
              "alone, one thread; what a particle costs that every pass concerns, its walls' share "
              "included",
              {}};
  for (std::size_t k = 0; k < everything.seconds.size(); ++k) {
    rate.repeats.push_back(1e-6 * particles * concerned.steps[k] / concerned.seconds[k]);
    flow.repeats.push_back(1e-6 * concerned.melt_steps[k] / concerned.flow_seconds[k]);
    beside_melt.repeats.push_back(concerned.seconds[k] / tracks.seconds[k]);
    speedup.repeats.push_back(everything.seconds[k] / tracks.seconds[k]);
  }
  StageResult result;
  result.details = {{"particles", pool.state.particles.size()},
                    {"liquid_particles", pool.liquid},
                    {"wall_particles", pool.wall},
                    {"mean_neighbours", pool.neighbours},
                    {"neighbour_list_bytes_per_particle", pool.list_bytes},
                    {"developed_at_us", 1e6 * pool.state.time},
                    {"developed_in_s", pool.seconds},
                    {"window_us", 1e6 * settings.window},
                    {"sorting_s_per_list_build", sorting},
                    {"as_tracks_run", tracks.details()},
                    {"nothing_skipped", concerned.details()},
                    {"everything_computed", everything.details()}};
  result.figures = {std::move(rate), std::move(speedup), std::move(beside_melt), std::move(flow),
                    pool.memory};
  return result;
}

}  // namespace meltproof::solver

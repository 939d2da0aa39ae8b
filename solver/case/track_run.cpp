// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/case/track_run.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "base/error.hpp"
#include "base/progress.hpp"
#include "base/stop_request.hpp"
#include "solver/case/time_left.hpp"
#include "solver/case/track_files.hpp"
#include "solver/case/track_result.hpp"
#include "solver/output/checkpoint.hpp"
#include "solver/output/run_summary.hpp"
#include "solver/output/whole.hpp"

namespace meltproof::solver {
namespace {

/// A run under way.
class TrackRun {
 public:
  TrackRun(const TrackCase& track, const RunOptions& options, Provenance provenance)
      : t_(track),
        options_(options),
        ranks_(options.ranks),
        provenance_(std::move(provenance)),
        mixture_(read_mixture(track)),
        made_(discretise(track, mixture_)),
        checkpoints_(options.folder, options.ranks),
        reference_(pool_isotherm(track, mixture_)),
        judged_(track_acceptance(made_.domain.lower, made_.domain.upper,
                                 track.speed * track.exposure, track.beam_radius)),
        time_left_(options.melt_of.empty() ? TimeLeft() : TimeLeft(read_melt(options.melt_of))),
        begun_(std::chrono::steady_clock::now()),
        written_(begun_) {}

  nlohmann::json carry_out() {
    provenance_.ranks = ranks_.size();
    start();
    if (!restarted_) {
      run_.lines = {measure(*engine_, reference_, run_.start_enthalpy)};
      run_.history = 1;
      take_snapshot();
    }
    {
      const StopRequest stop;
      Progress progress(options_.name, t_.exposure, std::min(engine_->time(), t_.exposure));
      spanned_ = engine_->time();
      span_began_ = seconds();
      while (engine_->time() < end() && advance(stop, progress)) {
      }
    }
    return finish();
  }

 private:
  std::size_t particle_count() const {
    const auto& home = engine_->particles().home;
    return ranks_.add(static_cast<std::uint64_t>(std::count(home.begin(), home.end(), Home::here)));
  }

  double end() const { return t_.exposure + t_.cooling_limit; }

  double seconds() const {
    return earlier_ +
           std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
  }

  void start() {
    for (const auto& sentence : warnings(t_, mixture_)) {
      spdlog::warn("{}", sentence);
    }
    const Diffusivity diffusivity = read_diffusivity(t_.diffusivity_laws, t_.diffusivity_law);
    const Model model = make_model(t_, made_.domain);
    if (options_.restart) {
      made_.particles = {};  // a checkpoint holds them
      if (auto found = checkpoints_.newest(provenance_)) {
        run_ = std::move(found->run);
        engine_.emplace(std::move(found->engine), mixture_, diffusivity, model, ranks_);
        restarted_ = true;
        earlier_ = run_.wall_time;
        spdlog::info("{}: goes on from {}, {:.1f} of {:.1f} us", options_.name,
                     found->file.string(), 1e6 * engine_->time(), 1e6 * t_.exposure);
      } else {
        spdlog::info("{}: no checkpoint in {}, so from the beginning", options_.name,
                     checkpoints_.folder().string());
        made_ = discretise(t_, mixture_);
      }
    }
    if (!restarted_) {
      checkpoints_.clear();
      engine_.emplace(std::move(made_.particles), mixture_, diffusivity, model, ranks_);
      run_.start_enthalpy = engine_->total_enthalpy();
      run_.start_additive = engine_->total_additive_mass();
    }
    made_.particles = {};
    const Domain& box = made_.domain;
    spdlog::info("{}: {} particles, spacing {:.3g} um, domain {:.0f} x {:.0f} x {:.0f} um",
                 options_.name, particle_count(), 1e6 * t_.spacing,
                 1e6 * (box.upper[0] - box.lower[0]), 1e6 * (box.upper[1] - box.lower[1]),
                 1e6 * (box.upper[2] - box.lower[2]));
  }

  /// To the next line of the history, snapshot, or the moment at which the beam goes off.
  /// @returns whether there is anything left to happen.
  bool advance(const StopRequest& stop, Progress& progress) {
    const double next_line = static_cast<double>(run_.history) * t_.history_interval;
    const double next_frame = static_cast<double>(run_.snapshots) / t_.frame_rate;
    double until = std::min({next_line, end(), next_frame < t_.exposure ? next_frame : end()});
    until = engine_->time() < t_.exposure ? std::min(until, t_.exposure) : until;
    double dt = 0;
    while (engine_->time() < until) {
      dt = step(until);
      if (engine_->time() < until) {
        save_if_due(stop);
      }
    }
    bool goes_on = true;
    if (engine_->time() == next_line || engine_->time() == t_.exposure) {
      goes_on = note(dt, engine_->time() == next_line, progress);
    }
    if (engine_->time() == next_frame && next_frame < t_.exposure) {
      take_snapshot();
    }
    if (goes_on) {
      save_if_due(stop);
    }
    return goes_on;
  }

  double step(double until) {
    double dt = 0;
    try {
      dt = engine_->step(until);
    } catch (const std::runtime_error& problem) {
      throw std::runtime_error(fmt::format("{}; {}", problem.what(), checkpoints_.last_good()));
    }
    const LaserBudget& beam = engine_->beam();
    if (engine_->time() <= t_.exposure) {
      run_.beam_balance =
          std::max(run_.beam_balance,
                   std::abs(beam.absorbed + beam.reflected + beam.missed - t_.power) / t_.power);
    }
    return dt;
  }

  /// A line of the history. @returns whether there is any melt left to freeze.
  bool note(double dt, bool regular, Progress& progress) {
    run_.lines.push_back(measure(*engine_, reference_, run_.start_enthalpy));
    run_.lines.back().step = dt;
    run_.history += regular ? 1 : 0;
    const HistoryLine& now = run_.lines.back();
    if (!options_.quiet) {
      const std::string state = fmt::format(
          "step {}, t {:.1f} us, dt {:.3f} us, pool {:.0f} um, peak {:.0f} K", engine_->steps(),
          1e6 * now.time, 1e6 * dt, 1e6 * now.pool.length, now.peak_temperature);
      // History lines are a few microseconds apart, so a span is what came since the last one.
      const double span = now.time - spanned_, wall = seconds();
      time_left_.add(span, wall - span_began_, now.liquid_volume);
      spanned_ = now.time;
      span_began_ = wall;
      if (const auto left = time_left_.seconds(now.time)) {
        progress.say(fmt::format("{:.1f} %, {} left and {} in all if the melt grows as in {}; {}",
                                 100 * std::min(1.0, now.time / t_.exposure), duration_text(*left),
                                 duration_text(wall + *left), options_.melt_of.string(), state));
      } else if (engine_->time() <= t_.exposure) {
        progress.update(engine_->time(), state);
      } else {
        // Nobody knows when the last of it will be solid, only until when it would be waited for.
        progress.say(fmt::format("beam off, freezing ({:.0f} us at most); {}", 1e6 * end(), state));
      }
    }
    if (engine_->time() == t_.exposure) {
      // At the end all is solid: how the melt fared is measured as the beam goes off.
      const Whole whole(*engine_);
      if (ranks_.root()) {
        const Acceptance melt = measure_acceptance(whole.particles(), judged_);
        run_.melt = melt.liquid;
        run_.melt_volume = melt.liquid_volume;
      }
    }
    return engine_->time() <= t_.exposure || melt_left(*engine_) ||
           (!engine_->model().flow && ranks_.any(now.pool.found || now.any_liquid.found));
  }

  /// Writes something; should that fail, says what there is to go on from.
  template <class Write>
  void keep(const Write& write) {
    const double begun = seconds();
    try {
      write();
      writing_ += seconds() - begun;
    } catch (const InputError&) {
      throw;  // nothing that room would cure
    } catch (const std::runtime_error& problem) {
      throw std::runtime_error(fmt::format("{}; {}; make room and use --restart", problem.what(),
                                           checkpoints_.last_good()));
    }
  }

  void take_snapshot() {
    keep([&] { checkpoints_.write_snapshot(run_.snapshots, *engine_, provenance_); });
    ++run_.snapshots;
  }

  void save_if_due(const StopRequest& stop) {
    const auto now = std::chrono::steady_clock::now();
    const double since = std::chrono::duration<double>(now - written_).count();
    const bool due =
        (options_.checkpoint_interval > 0 && since >= options_.checkpoint_interval) ||
        (options_.checkpoint_steps > 0 && engine_->steps() % options_.checkpoint_steps == 0);
    // Clocks and signals differ between ranks: what one of them thinks, all do.
    std::array<double, 2> wishes{due ? 1.0 : 0.0, stop.made() ? 1.0 : 0.0};
    ranks_.largest(wishes);
    const bool stopping = wishes[1] > 0;
    if (wishes[0] == 0 && !stopping) {
      return;
    }
    if (engine_->gas() != nullptr) {
      if (stopping) {
        throw Stopped("a run with surroundings = \"gas\" keeps no checkpoints: it begins anew");
      }
      return;
    }
    run_.wall_time = seconds();
    std::filesystem::path place;
    keep([&] { place = checkpoints_.write(*engine_, run_, provenance_); });
    written_ = std::chrono::steady_clock::now();
    if (stopping) {
      if (!options_.quiet && ranks_.root()) {
        provenance_.wall_time = run_.wall_time;
        fmt::print("{}: {}\n", options_.name,
                   time_line(step_timings(*engine_), provenance_, engine_->steps()));
      }
      throw Stopped(
          fmt::format("at {:.1f} of {:.1f} us, with a checkpoint in {}; the same command with "
                      "--restart goes on "
                      "from there",
                      1e6 * engine_->time(), 1e6 * t_.exposure, place.string()));
    }
  }

  nlohmann::json finish() {
    spdlog::info("{} thermal and {} flow steps, {} list builds; {:.1f} s for files",
                 engine_->steps(), engine_->flow_steps(), engine_->list_builds(), writing_);
    // The last snapshot is the solidified track.
    take_snapshot();
    const Whole whole(*engine_);
    Acceptance acceptance;
    if (ranks_.root()) {
      acceptance = measure_acceptance(whole.particles(), judged_);
    }
    acceptance.liquid = run_.melt;
    acceptance.liquid_volume = run_.melt_volume;
    if (engine_->model().flow) {
      acceptance.clumped_mean = clumped_in_window(t_, run_.lines);
    }
    provenance_.wall_time = run_.wall_time = seconds();
    nlohmann::json result = track_result(t_, made_, *engine_, run_, whole.particles(), acceptance);
    result["case"] = options_.name;
    result["provenance"] = provenance_.json();
    keep([&] {
      write_track_files(options_.folder, t_, *engine_, made_, checkpoints_, run_, provenance_,
                        result);
    });
    checkpoints_.clear();
    if (!options_.quiet && ranks_.root()) {
      print_run_summary(result, acceptance, step_timings(*engine_), provenance_, options_.folder);
    }
    return result;
  }

  const TrackCase& t_;
  const RunOptions& options_;
  Ranks ranks_;
  Provenance provenance_;
  Mixture mixture_;
  Discretisation made_;
  CheckpointFolder checkpoints_;
  double reference_;  // K, outlines the pool
  AcceptanceSettings judged_;
  TimeLeft time_left_;
  double spanned_ = 0, span_began_ = 0;  // s, simulated and of the clock, of the last history line
  std::optional<Engine> engine_;
  RunProgress run_;
  bool restarted_ = false;
  double earlier_ = 0;  // s, of the parts of the run before this one
  double writing_ = 0;  // s, of this one, for snapshots and checkpoints
  std::chrono::steady_clock::time_point begun_, written_;
};

}  // namespace

nlohmann::json run_track(const TrackCase& track, const RunOptions& options, Provenance provenance) {
  return TrackRun(track, options, std::move(provenance)).carry_out();
}

}  // namespace meltproof::solver

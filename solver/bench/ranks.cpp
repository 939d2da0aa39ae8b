// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <map>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "base/progress.hpp"
#include "solver/bench/stages.hpp"
#include "solver/case/track_result.hpp"

namespace meltproof::solver {
namespace {

/// Advances by a window; the ranks begin and end together. @returns seconds on the root.
double timed(Engine& engine, double until, const Ranks& ranks) {
  ranks.meet();
  const auto begun = std::chrono::steady_clock::now();
  while (engine.time() < until) {
    engine.step(until);
  }
  ranks.meet();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

/// What an acoustic step sends, and how evenly the work lies.
nlohmann::json traffic(const Engine& engine, std::size_t messages_before, double megabytes_before,
                       std::size_t steps_before) {
  const Ranks& ranks = engine.ranks();
  const auto steps = static_cast<double>(engine.flow_steps() - steps_before);
  const auto& home = engine.particles().home;
  std::array<double, 4> most{
      static_cast<double>(engine.halo().messages() - messages_before) / steps,
      1e6 * (engine.halo().megabytes() - megabytes_before) / steps,
      static_cast<double>(std::count(home.begin(), home.end(), Home::here)),
      static_cast<double>(std::count(home.begin(), home.end(), Home::elsewhere))};
  ranks.largest(most);
  return {{"ranks", ranks.size()},
          {"messages_per_rank_and_acoustic_step", most[0]},
          {"bytes_per_rank_and_acoustic_step", most[1]},
          {"most_particles_of_a_rank", most[2]},
          {"most_copies_on_a_rank", most[3]},
          {"largest_over_mean_work", engine.imbalance()}};
}

}  // namespace

StageResult ranks_against_one(const TrackCase& track, double until, const BenchSettings& settings,
                              const Ranks& ranks) {
  Mixture mixture = read_mixture(track);
  const Diffusivity diffusivity = read_diffusivity(track.diffusivity_laws, track.diffusivity_law);
  Discretisation made = discretise(track, mixture);
  const Model model = make_model(track, made.domain);
  const std::size_t particles = made.particles.size();
  Engine shared(std::move(made.particles), mixture, diffusivity, model, ranks);
  std::optional<Progress> progress;
  if (ranks.root()) {
    progress.emplace(fmt::format("pool develops on {} ranks", ranks.size()), until);
  }
  while (shared.time() < until) {
    shared.step(until);
    if (progress) {
      progress->update(shared.time(), fmt::format("{} particles", particles));
    }
  }
  std::optional<Engine> alone;
  {
    EngineState state = shared.state_everywhere();
    if (ranks.root()) {
      alone.emplace(std::move(state), mixture, diffusivity, model);
    }
  }
  Figure figure{fmt::format("ranks_{}_over_1", ranks.size()),
                "1",
                "wall-clock time of the same simulated time on one rank over that on several, a "
                "thread each, on one machine, in turns from the same state",
                {}};
  const auto parts = [](const Engine& engine) {
    const Timings timings = step_timings(engine);
    return std::map<std::string, double>(timings.begin(), timings.end());
  };
  const auto shared_before = parts(shared), alone_before = alone ? parts(*alone) : shared_before;
  std::vector<double> one, several;
  const std::size_t messages = shared.halo().messages(), steps = shared.flow_steps();
  const double megabytes = shared.halo().megabytes();
  if (progress) {
    progress.emplace("one rank and several", settings.repeats);
  }
  for (int repeat = 0; repeat < settings.repeats; ++repeat) {
    const double end = until + (repeat + 1) * settings.window;
    ranks.meet();
    if (alone) {
      one.push_back(timed(*alone, end, Ranks()));
    }
    ranks.meet();
    several.push_back(timed(shared, end, ranks));
    if (progress) {
      progress->update(repeat + 1);
    }
  }
  StageResult result;
  result.details = traffic(shared, messages, megabytes, steps);
  result.details["particles"] = particles;
  result.details["window_us"] = 1e6 * settings.window;
  result.details["developed_at_us"] = 1e6 * until;
  result.details["acoustic_steps"] = shared.flow_steps() - steps;
  // Of the root: with the time that it waited for others.
  for (const auto& [part, seconds] : step_timings(shared)) {
    result.details["parts_on_several_s"][part] = seconds - shared_before.at(part);
  }
  if (alone) {
    for (const auto& [part, seconds] : step_timings(*alone)) {
      result.details["parts_on_one_s"][part] = seconds - alone_before.at(part);
    }
  }
  result.details["seconds_on_one"] = one;
  result.details["seconds_on_several"] = several;
  for (std::size_t k = 0; k < one.size(); ++k) {
    figure.repeats.push_back(one[k] / several[k]);
  }
  if (ranks.root()) {
    result.figures.push_back(std::move(figure));
  }
  return result;
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/bench/developed_pool.hpp"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/progress.hpp"

namespace meltproof::solver {

DevelopedPool develop_pool(const TrackCase& track, double until) {
  Mixture mixture = read_mixture(track);
  Diffusivity diffusivity = read_diffusivity(track.diffusivity_laws, track.diffusivity_law);
  const double before = resident_memory().now;
  Discretisation made = discretise(track, mixture);
  const Model model = make_model(track, made.domain);
  if (!model.flow || model.gas) {
    throw InputError(
        "whole steps are timed with a melt that flows and a free surface: flow.enabled must be "
        "true and flow.surroundings \"free\"");
  }
  const std::size_t particles = made.particles.size();
  const auto begun = std::chrono::steady_clock::now();
  Engine engine(std::move(made.particles), mixture, diffusivity, model);
  {
    Progress progress("pool develops", until);
    while (engine.time() < until) {
      engine.step(until);
      progress.update(engine.time(), fmt::format("{} particles, {} liquid", particles,
                                                 engine.flow().liquid().size()));
    }
  }
  const double peak = resident_memory().peak;
  DevelopedPool pool{.mixture = std::move(mixture),
                     .diffusivity = std::move(diffusivity),
                     .model = model,
                     .state = engine.state(),
                     .memory = {"bytes_per_particle",
                                "B",
                                "peak resident memory of the program while it discretised the "
                                "track and simulated it, less what was resident before, over all "
                                "particles; neighbour lists and passing copies included",
                                {(peak - before) / static_cast<double>(particles)}}};
  pool.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  pool.liquid = engine.flow().liquid().size();
  pool.wall = engine.flow().wall().size();
  if (pool.liquid == 0) {
    throw InputError(
        fmt::format("nothing is liquid at {:g} us: there is no pool to time; take a later --until",
                    1e6 * until));
  }
  const PackedLists& list = engine.neighbours();
  pool.neighbours = list.mean_neighbours();
  pool.list_bytes = static_cast<double>(list.code.size() * sizeof(list.code[0])) /
                    static_cast<double>(particles);
  return pool;
}

}  // namespace meltproof::solver

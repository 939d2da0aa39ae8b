// SPDX-License-Identifier: GPL-3.0-or-later
// Taking the state out of an engine, and an engine that goes on from one.
#include <stdexcept>

#include "solver/particles/block_sum.hpp"
#include "solver/step/engine.hpp"

namespace meltproof::solver {

EngineState Engine::state() const {
  if (gas_) {
    throw std::logic_error("a run with gas around the metal cannot be stopped and continued");
  }
  EngineState state;
  state.particles = particles_;
  state.listed_at = flow_ ? built_at_ : particles_.position;
  state.mobile = mobile_;
  if (flow_) {
    state.flow = flow_->memory();
    state.limiters = flow_->limiters();
    state.melt = melt_;
  }
  state.ledger = ledger_;
  state.limits = limits_;
  state.times = times_;
  state.time = time_;
  state.start_temperature = start_temperature_;
  state.steps = steps_;
  state.flow_steps = flow_count_;
  state.list_builds = list_builds_;
  state.builds_since_sort = builds_since_sort_;
  state.lost = lost_;
  return state;
}

Engine::Engine(EngineState state, Mixture mixture, Diffusivity diffusivity, const Model& model)
    : particles_(std::move(state.particles)),
      mixture_(std::move(mixture)),
      diffusivity_law_(std::move(diffusivity)),
      model_(model),
      kernel_(lattice_kernel(particles_.spacing, model.smoothing_ratio, particles_.dimensions,
                             model.heat_moments)),
      species_kernel_(lattice_kernel(particles_.spacing, model.smoothing_ratio,
                                     particles_.dimensions, model.species_moments)),
      neighbours_(kernel_.support(), model.flow ? model.flow->skin * particles_.spacing : 0),
      start_temperature_(state.start_temperature),
      limits_(state.limits),
      ledger_(state.ledger),
      time_(state.time),
      steps_(state.steps),
      melt_(std::move(state.melt)),
      mobile_(std::move(state.mobile)),
      built_at_(std::move(state.listed_at)),
      flow_count_(state.flow_steps),
      list_builds_(state.list_builds),
      builds_since_sort_(state.builds_since_sort),
      lost_(state.lost),
      times_(state.times) {
  if (model_.gas) {
    throw std::logic_error("a run with gas around the metal cannot be stopped and continued");
  }
  // The lists as they were made: with who stood where then. Lists that were older than that one
  // hold nobody who has moved since, so they come out the same.
  const std::vector<Vector> now = particles_.position;
  particles_.position = built_at_;
  prepare();
  particles_.position = now;
  if (flow_) {
    flow_->arrange(particles_, ghosts_, neighbours_.list(), true);
  }
  place_records();
  for_each_particle(particles_.size(), [&](std::size_t i) { refresh(i); });
  refresh_ghosts();
  if (flow_) {
    flow_->remember(state.flow, state.limiters);
  } else if (model_.laser || model_.surface_loss) {
    surface_ = find_surface(particles_, model_.domain.lower, model_.domain.upper,
                            model_.laser ? model_.laser->slant() : Slant{});
  }
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// Taking the state out of an engine, and an engine that goes on from one.
#include <stdexcept>

#include "solver/particles/loops.hpp"
#include "solver/step/engine.hpp"
#include "solver/step/state_parts.hpp"

namespace meltproof::solver {
namespace {

/// The arrays of a state from what each rank sent of its particles.
void write_particles(EngineState& state, const std::vector<Traveller>& all) {
  Particles& p = state.particles;
  p.each_array([&](auto& values) { values.assign(all.size(), {}); });
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Traveller& t = all[i];
    t.write(p, i);
    p.order[i] = i;
    p.home[i] = Home::here;
    state.listed_at.push_back(t.listed_at);
    state.mobile.push_back(t.mobile);
    state.pace.push_back(t.pace);
    state.slow_power.push_back(t.slow_power);
    if (t.phase == Phase::liquid) {
      remember(state.flow, t.flow);
    }
  }
}

}  // namespace

EngineState Engine::state(bool everywhere) const {
  EngineState state = state_numbers();
  if (ranks().alone()) {
    state.particles = particles_;
    state.listed_at = particles_.position;
    for (std::size_t k = 0; k < movers_.size(); ++k) {
      state.listed_at[movers_[k]] = built_at_[k];
    }
    state.mobile = mobile_;
    state.pace = pace_;
    state.slow_power = slow_power_;
    if (flow_) {
      state.flow = flow_->memory();
    }
  } else {
    write_particles(state, gather({}, everywhere));
  }
  return state;
}

EngineState Engine::state_numbers() const {
  if (gas_) {
    throw std::logic_error("a run with gas around the metal cannot be stopped and continued");
  }
  EngineState state;
  state.particles.spacing = particles_.spacing;
  state.particles.dimensions = particles_.dimensions;
  state.limiters = limiters();
  state.ledger = ledger_;
  state.limits = limits_;
  state.times = times_;
  state.time = time_;
  state.round_time = round_time_;
  state.start_temperature = start_temperature_;
  state.steps = steps_;
  state.flow_steps = flow_count_;
  state.list_builds = list_builds_;
  state.builds_since_sort = builds_since_sort_;
  state.lost = lost_;
  return state;
}

StateView Engine::state_view() const {
  StateView view{particles_, {}, mobile_, pace_, slow_power_, {}, {}};
  for (std::uint32_t i = 0; i < particles_.size(); ++i) {
    if (particles_.home[i] == Home::here) {
      view.own.push_back(i);
    }
  }
  view.listed_at = [this](std::uint32_t i) { return listed_at(i); };
  if (flow_) {
    view.flow = [this](std::uint32_t i) { return flow_->particle(i); };
  }
  return view;
}

LimiterCounts Engine::limiters() const {
  if (!flow_) {
    return {};
  }
  LimiterCounts counts = flow_->limiters();
  for (std::uint64_t* count :
       {&counts.wall_pressure, &counts.curvature, &counts.particle_steps, &counts.wall_steps}) {
    *count = ranks().add(*count);
  }
  return counts;
}

/// Of the part of a state that was given to this rank, makes the one that belongs to it.
void Engine::take_part(EngineState& state) {
  std::vector<Decomposition::Cost> costs;
  for (const Phase phase : particles_.phase) {
    costs.push_back(Decomposition::cost_at_first(phase));
  }
  decomposition_.balance(state.listed_at, costs);
  state.mobile = std::move(mobile_);
  state.pace = std::move(pace_);
  state.slow_power = std::move(slow_power_);
  const std::vector<Traveller> all =
      share_out(state, particles_, ranks(), decomposition_, copy_reach());
  for (auto* flags : {&mobile_, &pace_}) {
    flags->assign(all.size(), 0);
  }
  slow_power_.assign(all.size(), 0);
  particles_.each_array([&](auto& values) {
    values = {};
    values.resize(all.size());
  });
  state.listed_at.resize(all.size());
  state.flow = {};
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    const Traveller& t = all[i];
    const bool here = t.rank == ranks().rank();
    unpack(i, t, here ? Home::here : Home::elsewhere);
    state.listed_at[i] = t.listed_at;
    if (here && t.phase == Phase::liquid) {
      remember(state.flow, t.flow);
    }
  }
  add_free_slots();
  note_peers(state.listed_at);
  state.listed_at.resize(particles_.size());  // free entries behind
}

Engine::Engine(EngineState state, Mixture mixture, Diffusivity diffusivity, const Model& model,
               const Ranks& ranks)
    : particles_(std::move(in_order(state).particles)),
      mixture_(std::move(mixture)),
      diffusivity_law_(std::move(diffusivity)),
      model_(model),
      kernel_(lattice_kernel(particles_.spacing, model.smoothing_ratio, particles_.dimensions,
                             model.heat_moments)),
      species_kernel_(lattice_kernel(particles_.spacing, model.smoothing_ratio,
                                     particles_.dimensions, model.species_moments)),
      halo_(std::make_unique<Halo>(ranks)),
      decomposition_(ranks),
      neighbours_(kernel_.support(), model.flow ? model.flow->skin * particles_.spacing : 0),
      pace_(std::move(state.pace)),
      slow_power_(std::move(state.slow_power)),
      round_time_(state.round_time),
      round_open_(state.round_time > 0),
      start_temperature_(state.start_temperature),
      limits_(state.limits),
      ledger_(state.ledger),
      time_(state.time),
      steps_(state.steps),
      mobile_(std::move(state.mobile)),
      flow_count_(state.flow_steps),
      list_builds_(state.list_builds),
      builds_since_sort_(state.builds_since_sort),
      lost_(state.lost),
      times_(state.times) {
  if (model_.gas) {
    throw std::logic_error("a run with gas around the metal cannot be stopped and continued");
  }
  times_at_balance_ = times_;
  if (!ranks.alone()) {
    check_ranks();
    take_part(state);
    if (!ranks.root()) {
      state.limiters = {};  // counted once
    }
  }
  // The lists as they were made: with who stood where then. Lists that were older than that one
  // hold nobody who has moved since, so they come out the same.
  const std::vector<Vector> now = particles_.position;
  particles_.position = std::move(state.listed_at);
  prepare();
  find_movers();
  particles_.position = now;
  if (flow_) {
    flow_->arrange(particles_, ghosts_, neighbours_.list());
  }
  place_records();
  for_each_particle(particles_.size(), [&](std::size_t i) { refresh(i); });
  refresh_ghosts();
  if (flow_) {
    flow_->remember(state.flow, state.limiters);
  } else {
    look_from_above();
  }
}

}  // namespace meltproof::solver

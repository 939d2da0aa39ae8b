// SPDX-License-Identifier: GPL-3.0-or-later
// Taking the state out of an engine, and an engine that goes on from one.
#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "solver/particles/loops.hpp"
#include "solver/step/engine.hpp"

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
    state.fast.push_back(t.fast);
    state.slow_power.push_back(t.slow_power);
    if (t.phase == Phase::liquid) {
      state.flow.acceleration.push_back(t.flow.acceleration);
      state.flow.shift.push_back(t.flow.shift);
      state.flow.area.push_back(t.flow.exposed);
      state.flow.pressure.push_back(t.flow.pressure);
      state.flow.viscosity.push_back(t.flow.properties.viscosity);
      state.flow.surface_tension.push_back(t.flow.properties.surface_tension);
      state.flow.recoil.push_back(t.flow.properties.recoil);
    }
  }
}

/// The entries of a flow's memory that belong to the melt of this rank.
/// @param phases of all particles; @param kept those that this rank keeps of them; @param home of
/// these.
FlowMemory part_of(const FlowMemory& memory, const std::vector<Phase>& phases,
                   const std::vector<std::uint32_t>& kept, const std::vector<Home>& home) {
  std::vector<std::size_t> place(phases.size(), 0);
  std::size_t count = 0;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    place[i] = count;
    count += phases[i] == Phase::liquid ? 1 : 0;
  }
  FlowMemory part;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    if (home[k] == Home::here && phases[kept[k]] == Phase::liquid) {
      const std::size_t at = place[kept[k]];
      part.acceleration.push_back(memory.acceleration[at]);
      part.shift.push_back(memory.shift[at]);
      part.area.push_back(memory.area[at]);
      part.pressure.push_back(memory.pressure[at]);
      part.viscosity.push_back(memory.viscosity[at]);
      part.surface_tension.push_back(memory.surface_tension[at]);
      part.recoil.push_back(memory.recoil[at]);
    }
  }
  return part;
}

}  // namespace

EngineState Engine::state(bool everywhere) const {
  if (gas_) {
    throw std::logic_error("a run with gas around the metal cannot be stopped and continued");
  }
  EngineState state;
  state.particles.spacing = particles_.spacing;
  state.particles.dimensions = particles_.dimensions;
  if (ranks().alone()) {
    state.particles = particles_;
    state.listed_at = particles_.position;
    for (std::size_t k = 0; k < movers_.size(); ++k) {
      state.listed_at[movers_[k]] = built_at_[k];
    }
    state.mobile = mobile_;
    state.fast = fast_;
    state.slow_power = slow_power_;
    if (flow_) {
      state.flow = flow_->memory();
    }
  } else {
    write_particles(state, gather({}, everywhere));
  }
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

Engine::Engine(EngineState state, Mixture mixture, Diffusivity diffusivity, const Model& model,
               const Ranks& ranks)
    : particles_(std::move(state.particles)),
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
      fast_(std::move(state.fast)),
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
  std::iota(particles_.order.begin(), particles_.order.end(), 0U);
  times_at_balance_ = times_;
  if (!ranks.alone()) {
    check_ranks();
    // Whose a particle is follows from where it was when the lists were made.
    const std::vector<Phase> phases = particles_.phase;
    const std::vector<std::uint32_t> kept = divide(state.listed_at);
    std::vector<Vector> listed_at(particles_.size());  // free entries behind
    std::transform(kept.begin(), kept.end(), listed_at.begin(),
                   [&](std::uint32_t i) { return state.listed_at[i]; });
    state.listed_at = std::move(listed_at);
    state.flow = part_of(state.flow, phases, kept, particles_.home);
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

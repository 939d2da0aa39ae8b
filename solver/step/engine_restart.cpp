// SPDX-License-Identifier: GPL-3.0-or-later
// Taking the state out of an engine, and an engine that goes on from one.
#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "solver/particles/loops.hpp"
#include "solver/step/engine.hpp"

namespace meltproof::solver {
namespace {

void remember(FlowMemory& memory, const FlowParticle& particle) {
  memory.acceleration.push_back(particle.acceleration);
  memory.shift.push_back(particle.shift);
  memory.area.push_back(particle.exposed);
  memory.pressure.push_back(particle.pressure);
  memory.viscosity.push_back(particle.properties.viscosity);
  memory.surface_tension.push_back(particle.properties.surface_tension);
  memory.recoil.push_back(particle.properties.recoil);
}

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
      remember(state.flow, t.flow);
    }
  }
}

template <class T>
void permute(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
  if (!values.empty()) {
    std::vector<T> sorted;
    sorted.reserve(order.size());
    for (const std::uint32_t i : order) {
      sorted.push_back(values[i]);
    }
    values = std::move(sorted);
  }
}

template <class Visit>
void each_array(FlowMemory& m, const Visit& visit) {
  visit(m.acceleration);
  visit(m.shift);
  visit(m.area);
  visit(m.pressure);
  visit(m.viscosity);
  visit(m.surface_tension);
  visit(m.recoil);
}

/// Per particle its entry in a flow's memory, which holds the liquid ones.
std::vector<std::uint32_t> places_in_flow(const std::vector<Phase>& phases) {
  std::vector<std::uint32_t> place(phases.size(), 0);
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    place[i] = count;
    count += phases[i] == Phase::liquid ? 1 : 0;
  }
  return place;
}

/// Puts a state in the engine's order, which sums follow.
EngineState& in_order(EngineState& state) {
  Particles& p = state.particles;
  std::vector<std::uint32_t> order(p.size()), liquid;
  std::iota(order.begin(), order.end(), 0U);
  const auto before = [&](std::uint32_t a, std::uint32_t b) { return p.before(a, b); };
  if (std::is_sorted(order.begin(), order.end(), before)) {
    return state;
  }
  std::sort(order.begin(), order.end(), before);
  const std::vector<std::uint32_t> place = places_in_flow(p.phase);
  for (const std::uint32_t i : order) {
    if (p.phase[i] == Phase::liquid) {
      liquid.push_back(place[i]);
    }
  }
  p.each_array([&](auto& values) { permute(values, order); });
  permute(state.listed_at, order);
  permute(state.mobile, order);
  permute(state.fast, order);
  permute(state.slow_power, order);
  each_array(state.flow, [&](auto& values) { permute(values, liquid); });
  return state;
}

/// Particle i of a state. @param in_flow its place in the flow's memory.
Traveller traveller(const EngineState& state, const Particles& p, std::size_t i,
                    std::uint32_t in_flow) {
  Traveller t{};
  t.read(p, i);
  t.listed_at = state.listed_at[i];
  t.mobile = state.mobile[i];
  t.fast = state.fast[i];
  t.slow_power = state.slow_power[i];
  if (p.phase[i] == Phase::liquid && !state.flow.area.empty()) {
    const FlowMemory& m = state.flow;
    t.flow.acceleration = m.acceleration[in_flow];
    t.flow.shift = m.shift[in_flow];
    t.flow.exposed = m.area[in_flow];
    t.flow.pressure = m.pressure[in_flow];
    t.flow.properties = {m.viscosity[in_flow], m.surface_tension[in_flow], m.recoil[in_flow]};
  }
  return t;
}

/// Sends the particles of a part of a state to their owners, and to those that keep copies of them.
/// Whose a particle is follows from where it was when the lists were made. A little at a time, so
/// that what is under way needs no memory to speak of.
/// @returns what belongs to this rank or is copied here, in the engine's order; Traveller::rank is
/// the owner.
std::vector<Traveller> share_out(const EngineState& state, const Particles& p, const Ranks& ranks,
                                 const Decomposition& decomposition, double reach) {
  constexpr std::size_t at_a_time = 8192;
  const std::vector<std::uint32_t> place = places_in_flow(p.phase);
  const auto most = static_cast<std::size_t>(ranks.largest(static_cast<double>(p.size())));
  std::vector<Traveller> found;
  std::vector<int> near;
  for (std::size_t begin = 0; begin < most; begin += at_a_time) {
    std::vector<std::vector<Traveller>> to(static_cast<std::size_t>(ranks.size()));
    for (std::size_t i = begin; i < std::min(p.size(), begin + at_a_time); ++i) {
      Traveller t = traveller(state, p, i, place[i]);
      t.rank = decomposition.owner(t.listed_at);
      decomposition.near(t.listed_at, reach, near);
      if (std::find(near.begin(), near.end(), t.rank) == near.end()) {
        near.push_back(t.rank);
      }
      for (const int r : near) {
        to[static_cast<std::size_t>(r)].push_back(t);
      }
    }
    const std::vector<Traveller> arrived = ranks.exchange(to);
    found.insert(found.end(), arrived.begin(), arrived.end());
  }
  std::sort(found.begin(), found.end(), comes_before);
  return found;
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
    state.fast = fast_;
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
  StateView view{particles_, {}, mobile_, fast_, slow_power_, {}, {}};
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
  state.fast = std::move(fast_);
  state.slow_power = std::move(slow_power_);
  const std::vector<Traveller> all =
      share_out(state, particles_, ranks(), decomposition_, copy_reach());
  for (auto* flags : {&mobile_, &fast_}) {
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

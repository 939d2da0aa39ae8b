// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/step/state_parts.hpp"

#include <algorithm>
#include <numeric>

namespace meltproof::solver {
namespace {

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

/// Particle i of a state. @param in_flow its place in the flow's memory.
Traveller traveller(const EngineState& state, const Particles& p, std::size_t i,
                    std::uint32_t in_flow) {
  Traveller t{};
  t.read(p, i);
  t.listed_at = state.listed_at[i];
  t.mobile = state.mobile[i];
  t.pace = state.pace[i];
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

}  // namespace

void remember(FlowMemory& memory, const FlowParticle& particle) {
  memory.acceleration.push_back(particle.acceleration);
  memory.shift.push_back(particle.shift);
  memory.area.push_back(particle.exposed);
  memory.pressure.push_back(particle.pressure);
  memory.viscosity.push_back(particle.properties.viscosity);
  memory.surface_tension.push_back(particle.properties.surface_tension);
  memory.recoil.push_back(particle.properties.recoil);
}

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
  permute(state.pace, order);
  permute(state.slow_power, order);
  each_array(state.flow, [&](auto& values) { permute(values, liquid); });
  return state;
}

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

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// What a checkpoint holds, field by field; only checkpoint_file.cpp includes this.
#pragma once

#include <cstddef>
#include <cstdint>

#include "solver/step/engine_state.hpp"

namespace meltproof::solver {

enum class Of { everybody, liquid };

/// Every field of the state: visit(name, units, of whom, array, value), where array(state) is what
/// holds it in an EngineState and value(view, i) what entry i of an engine has.
template <class Visit>
void each_field(const Visit& visit) {
  const auto particle = [&](const char* name, const char* units, auto field) {
    visit(
        name, units,
        Of::everybody, [field](EngineState & s) -> auto& { return s.particles.*field; },
        [field](const StateView& v, std::uint32_t i) { return (v.particles.*field)[i]; });
  };
  const auto flow = [&](const char* name, const char* units, auto field, const auto& value) {
    visit(
        name, units, Of::liquid, [field](EngineState & s) -> auto& { return s.flow.*field; },
        [&value](const StateView& v, std::uint32_t i) { return value(v.flow(i)); });
  };
  particle("identity", "1", &Particles::identity);
  particle("order", "1", &Particles::order);
  particle("position", "m", &Particles::position);
  particle("velocity", "m s-1", &Particles::velocity);
  particle("mass", "kg", &Particles::mass);
  particle("volume", "m3", &Particles::volume);
  particle("density", "kg m-3", &Particles::density);
  particle("enthalpy", "J kg-1", &Particles::enthalpy);
  particle("concentration", "1", &Particles::concentration);
  particle("temperature", "K", &Particles::temperature);
  particle("liquid_fraction", "1", &Particles::liquid_fraction);
  particle("peak_temperature", "K", &Particles::peak_temperature);
  particle("melt_time", "s", &Particles::melt_time);
  particle("freeze_time", "s", &Particles::freeze_time);
  particle("cooling_rate", "K s-1", &Particles::cooling_rate);
  particle("freeze_gradient", "K m-1", &Particles::freeze_gradient);
  particle("origin", "1", &Particles::origin);
  particle("phase", "1", &Particles::phase);
  particle("melted", "1", &Particles::melted);
  visit(
      "listed_at", "m", Of::everybody, [](EngineState & s) -> auto& { return s.listed_at; },
      [](const StateView& v, std::uint32_t i) { return v.listed_at(i); });
  visit(
      "mobile", "1", Of::everybody, [](EngineState & s) -> auto& { return s.mobile; },
      [](const StateView& v, std::uint32_t i) { return v.mobile[i]; });
  visit(
      "pace", "1", Of::everybody, [](EngineState & s) -> auto& { return s.pace; },
      [](const StateView& v, std::uint32_t i) { return v.pace[i]; });
  visit(
      "slow_power", "W m-3", Of::everybody, [](EngineState & s) -> auto& { return s.slow_power; },
      [](const StateView& v, std::uint32_t i) { return v.slow_power[i]; });
  flow("flow/acceleration", "m s-2", &FlowMemory::acceleration,
       [](const FlowParticle& f) { return f.acceleration; });
  flow("flow/shift", "m s-2", &FlowMemory::shift, [](const FlowParticle& f) { return f.shift; });
  flow("flow/area", "m2", &FlowMemory::area, [](const FlowParticle& f) { return f.exposed; });
  flow("flow/pressure", "Pa", &FlowMemory::pressure,
       [](const FlowParticle& f) { return f.pressure; });
  flow("flow/viscosity", "Pa s", &FlowMemory::viscosity,
       [](const FlowParticle& f) { return f.properties.viscosity; });
  flow("flow/surface_tension", "N m-1", &FlowMemory::surface_tension,
       [](const FlowParticle& f) { return f.properties.surface_tension; });
  flow("flow/recoil", "Pa", &FlowMemory::recoil,
       [](const FlowParticle& f) { return f.properties.recoil; });
}

/// The numbers of the state that are no arrays.
template <class State, class Visit>
void each_number(State& s, const Visit& visit) {
  visit("dimensions", s.particles.dimensions);
  visit("spacing", s.particles.spacing);
  visit("limiters", s.limiters);
  visit("ledger", s.ledger);
  visit("limits", s.limits);
  visit("times", s.times);
  visit("time", s.time);
  visit("round_time", s.round_time);
  visit("start_temperature", s.start_temperature);
  visit("steps", s.steps);
  visit("flow_steps", s.flow_steps);
  visit("list_builds", s.list_builds);
  visit("builds_since_sort", s.builds_since_sort);
  visit("lost", s.lost);
}

/// As what an entry is stored.
template <class T>
struct Stored {
  using Number = T;
  static constexpr std::size_t components = 1;
};
template <>
struct Stored<Vector> {
  using Number = double;
  static constexpr std::size_t components = 3;
};
template <>
struct Stored<Origin> {
  using Number = std::int32_t;
  static constexpr std::size_t components = 1;
};
template <>
struct Stored<std::uint64_t> {
  using Number = std::int64_t;
  static constexpr std::size_t components = 1;
};
template <>
struct Stored<Phase> {
  using Number = std::uint8_t;
  static constexpr std::size_t components = 1;
};

}  // namespace meltproof::solver

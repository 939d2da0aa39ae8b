// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "solver/flow/free_surface.hpp"
#include "solver/particles/particles.hpp"

namespace meltproof::solver {

/// All that is known of a particle, as it goes from one rank to another. What follows from
/// enthalpy and concentration alone is found anew where it arrives.
struct alignas(8) Traveller {
  std::int64_t identity;
  std::uint64_t order;
  Vector position, velocity, listed_at;
  double mass, volume, density, enthalpy, concentration, temperature, liquid_fraction,
      peak_temperature, melt_time, freeze_time, cooling_rate, freeze_gradient;
  double slow_power;  ///< W m-3, see Engine::exchange_heat()
  FlowParticle flow;
  Origin origin;
  std::int32_t rank;  ///< that sent it
  Phase phase;
  std::uint8_t melted, mobile, pace;

  /// From entry i of the arrays.
  void read(const Particles& p, std::size_t i) {
    identity = p.identity[i];
    order = p.order[i];
    position = p.position[i];
    velocity = p.velocity[i];
    mass = p.mass[i];
    volume = p.volume[i];
    density = p.density[i];
    enthalpy = p.enthalpy[i];
    concentration = p.concentration[i];
    temperature = p.temperature[i];
    liquid_fraction = p.liquid_fraction[i];
    peak_temperature = p.peak_temperature[i];
    melt_time = p.melt_time[i];
    freeze_time = p.freeze_time[i];
    cooling_rate = p.cooling_rate[i];
    freeze_gradient = p.freeze_gradient[i];
    origin = p.origin[i];
    phase = p.phase[i];
    melted = p.melted[i];
  }
  /// Into entry i of the arrays, but for its home.
  void write(Particles& p, std::size_t i) const {
    p.identity[i] = identity;
    p.order[i] = order;
    p.position[i] = position;
    p.velocity[i] = velocity;
    p.mass[i] = mass;
    p.volume[i] = volume;
    p.density[i] = density;
    p.enthalpy[i] = enthalpy;
    p.concentration[i] = concentration;
    p.temperature[i] = temperature;
    p.liquid_fraction[i] = liquid_fraction;
    p.peak_temperature[i] = peak_temperature;
    p.melt_time[i] = melt_time;
    p.freeze_time[i] = freeze_time;
    p.cooling_rate[i] = cooling_rate;
    p.freeze_gradient[i] = freeze_gradient;
    p.origin[i] = origin;
    p.phase[i] = phase;
    p.melted[i] = melted;
  }
};

/// As Particles::before().
inline bool comes_before(const Traveller& a, const Traveller& b) {
  return a.order != b.order ? a.order < b.order : a.identity < b.identity;
}

}  // namespace meltproof::solver

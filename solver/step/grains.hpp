// SPDX-License-Identifier: GPL-3.0-or-later
// For tests: a bare plate with grains of additive in it.
#pragma once

#include <cmath>
#include <cstddef>

#include "base/material.hpp"
#include "solver/particles/particles.hpp"

namespace meltproof::solver {

/// Makes pure additive, at 293.15 K, of what lies in cubes of 10 um every 40 um in x and y, down to
/// 10 um below z = 0.
inline void put_grains(Particles& p, const Mixture& mixture) {
  const auto within = [](double x) { return static_cast<int>(std::floor(x / 10e-6)) % 4 == 0; };
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vector& at = p.position[i];
    if (within(at[0]) && within(at[1]) && at[2] > -10e-6) {
      p.concentration[i] = 1;
      p.mass[i] = mixture.density(1) * p.volume[i];
      p.enthalpy[i] = mixture.enthalpy(293.15, 1);
    }
  }
}

}  // namespace meltproof::solver

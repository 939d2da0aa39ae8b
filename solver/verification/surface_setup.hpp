// SPDX-License-Identifier: GPL-3.0-or-later
// What the free-surface problems are built of: one melt and a wall of the same matter that never
// melts, blocks of particles, and what a flow at rest is judged by.
#pragma once

#include <functional>

#include "base/material.hpp"
#include "solver/particles/particles.hpp"
#include "solver/step/engine.hpp"
#include "solver/verification/case.hpp"

namespace meltproof::solver {

/// The case's melt (concentration 0), and a wall (concentration 1) that differs only in melting far
/// above every temperature. Uses density, viscosity, diffusivity (of heat) and surface_tension,
/// which is linear in the temperature: surface_tension + slope (T - temperature).
Mixture melt_and_wall(const VerificationCase& c);

/// What a cell of the lattice becomes.
enum class Fill { nothing, melt, wall };

/// A cubic lattice whose cells meet at the origin: cell (i, j, k) has its centre at (i + 1/2) dx,
/// and so on, for first <= i < last. In two dimensions k is left out and z = 0.
/// All particles at the case's temperature.
Particles fill_lattice(const VerificationCase& c, double spacing, const Mixture& mixture,
                       const std::array<std::int64_t, 3>& first,
                       const std::array<std::int64_t, 3>& last,
                       const std::function<Fill(const Vector&)>& fill);

/// Flow alone, as tracks use it: the default settings with the case's sound speed and gravity,
/// viscosity and surface tension of the mixture. Heat and species stand still. `variant` may name
/// another cure against clumping than the default: "none", "transport".
Model surface_model(const VerificationCase& c);

/// The liquid particles at rest with the pressure that `pressure` gives at their places, Pa.
void start_at_rest(Engine& engine, const std::function<double(const Vector&)>& pressure);

/// The flow as a whole, over the liquid particles.
struct FreeFlowState {
  double kinetic_energy = 0;    ///< J
  double fastest = 0;           ///< m s-1
  double root_mean_square = 0;  ///< m s-1, weighted by mass
  double clumped = 0;           ///< share with a neighbour nearer than half a spacing
};
FreeFlowState free_flow_state(const Engine& engine);

/// Mean pressure of the liquid particles that `where` picks, weighted by volume, Pa.
double mean_pressure(const Engine& engine, const std::function<bool(const Vector&)>& where);

}  // namespace meltproof::solver

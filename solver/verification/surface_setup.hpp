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
Particles fill_cells(const VerificationCase& c, double spacing, const Mixture& mixture,
                     const std::array<std::int64_t, 3>& first,
                     const std::array<std::int64_t, 3>& last,
                     const std::function<Fill(const Vector&)>& fill);

/// Flow alone, as tracks use it: the default settings with the case's sound speed and gravity,
/// viscosity and surface tension of the mixture. Heat and species stand still. `variant` may name
/// another cure against clumping than the default: "none", "transport"; or the other form of the
/// density diffusion, "corrected".
Model surface_model(const VerificationCase& c);

/// Starts the liquid particles at rest, with the pressure in Pa that `pressure` gives at their
/// places.
void start_at_rest(Engine& engine, const std::function<double(const Vector&)>& pressure);

/// The same in motion: the velocity in m s-1 by place.
void start_moving(Engine& engine, const std::function<double(const Vector&)>& pressure,
                  const std::function<Vector(const Vector&)>& velocity);

/// The flow as a whole, over the liquid particles.
struct MeltMotion {
  double kinetic_energy = 0;    ///< J
  double fastest = 0;           ///< m s-1
  double root_mean_square = 0;  ///< m s-1, weighted by mass
  double clumped = 0;           ///< share with a neighbour nearer than half a spacing
};
MeltMotion melt_motion(const Engine& engine);

/// Mean pressure of some liquid particles, weighted by volume, Pa.
struct MeanPressure {
  double state = 0;      ///< of the equation of state
  double repulsion = 0;  ///< that the repulsion against clumping adds, by its virial
  double total() const { return state + repulsion; }  ///< what acts on a plane through the melt
};

/// Over the particles that `where` picks. The virial is -1/(2 d V_i) sum (V_i^2 + V_j^2) p_ij r_ij
/// . grad W: on an undisturbed lattice the repulsion vanishes, in a melt that has been stirred it
/// carries some 10^4 Pa, by which the equation of state then carries less.
MeanPressure mean_pressure(const Engine& engine, const std::function<bool(const Vector&)>& where);

}  // namespace meltproof::solver

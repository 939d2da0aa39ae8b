// SPDX-License-Identifier: GPL-3.0-or-later
// Layers of melt on a solid wall, with a free surface above.
#pragma once

#include "solver/verification/case.hpp"

namespace meltproof::solver {

/// A layer of depth `height` at rest under strong gravity, periodic across, `width` wide. Exact:
/// p = p0 [(1 + M g/p0) exp(-g z/c^2) - 1] with M the melt's mass per area, that is rho g depth for
/// small compression. Uses height, width, density, viscosity, surface_tension, sound_speed,
/// gravity, steps. Error: L2 norm of p - p_exact over all melt particles, over that of p_exact,
/// after `steps` acoustic steps. Broken if the layer does not stay at rest: if it moves faster than
/// 1 % of sqrt(g height), or faster in the last quarter than in the first.
VerificationRun run_hydrostatic_free(const VerificationCase& c, double spacing);

/// A flat layer at one temperature under the recoil of its own vapour (that of 316L, Table A1),
/// without gravity. Exact: 0.54 p_sat everywhere below the surface. The particles get random
/// velocities of up to `speed` at the start, so that the answer is not that of an undisturbed
/// lattice. Uses height, width, temperature, density, viscosity, surface_tension, sound_speed,
/// speed, time. Error: of the pressure deeper than one support, averaged over the second half of
/// `time`.
VerificationRun run_recoil_flat(const VerificationCase& c, double spacing);

/// A layer between ends of unlike temperature, two-dimensional: the pull of its surface drives a
/// flow that returns below. Exact in the middle: u = tau h/mu (3/4 s^2 - s/2), s = z/h, which is
/// tau h/(4 mu) at the surface, tau = sigma_T dT/dx; heat is conducted so well that the temperature
/// stays linear. Uses length, height, temperature, temperature_gradient, surface_tension(_slope),
/// density, viscosity, diffusivity (of heat), gravity, sound_speed, time. Error: of the surface's
/// speed, by the parabola fitted to the layers of the middle third, averaged over the second half
/// of `time`.
VerificationRun run_thermocapillary_layer(const VerificationCase& c, double spacing);

}  // namespace meltproof::solver

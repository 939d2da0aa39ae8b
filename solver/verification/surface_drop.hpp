// SPDX-License-Identifier: GPL-3.0-or-later
// Drops in a vacuum.
#pragma once

#include "solver/verification/case.hpp"

namespace meltproof::solver {

/// A drop at rest, cut from the lattice by a sphere (in two dimensions a circle) of `radius` and
/// started at its exact pressure. Exact: p = (d - 1) sigma/R, with the R whose volume is that of the
/// particles, (3 V/4 pi)^(1/3). Uses radius, dimensions, density, viscosity, surface_tension,
/// sound_speed, time. Error: of the pressure within half the radius, averaged over the second half
/// of `time`. `extra`: the parasitic flow, as speeds and as capillary number eta u/sigma.
VerificationRun run_laplace_free(const VerificationCase& c, double spacing);

/// A drop that oscillates between prolate and oblate, started by the potential flow
/// v = speed/R (-x, -y, 2 z)/... of mode n = 2. Exact: Rayleigh's omega^2 = 8 sigma/(rho R^3), less the square of Lamb's
/// decay rate 5 nu/R^2. Uses radius, density, viscosity, surface_tension, sound_speed, speed, time.
/// Error: of the frequency, from a fit of a damped cosine to the second moments over all of `time`.
VerificationRun run_oscillating_drop(const VerificationCase& c, double spacing);

}  // namespace meltproof::solver

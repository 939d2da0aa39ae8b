// SPDX-License-Identifier: GPL-3.0-or-later
// Drops in a vacuum.
#pragma once

#include "solver/verification/case.hpp"

namespace meltproof::solver {

/// A drop at rest, cut from the lattice by a sphere (in two dimensions a circle) of `radius` and
/// started at its exact pressure. Exact: p = (d - 1) sigma/R, with the R whose volume is that of
/// the particles, (3 V/4 pi)^(1/3). Uses radius, dimensions, density, viscosity, surface_tension,
/// sound_speed, time. Error: of the pressure within half the radius, averaged over the second half
/// of `time`. `extra`: the parasitic flow, as speeds and as capillary number eta u/sigma.
VerificationRun run_laplace_free(const VerificationCase& c, double spacing);

/// A round drop that is set swinging between prolate and oblate by the potential flow of mode n =
/// 2, v = speed/(2 R) (-x, -y, 2 z), `speed` at the poles. Exact: the damped frequency sqrt(omega^2
/// - b^2) of small swings, omega^2 = 8 sigma/(rho R^3) (Rayleigh) and b = 5 nu/R^2 (Lamb). Uses
/// radius, density, viscosity, surface_tension, sound_speed, speed, time. Error: of the frequency,
/// from the least-squares fit of a damped swing to sum m (2 z^2 - x^2 - y^2) over all of `time`.
/// `extra`: the decay rate beside Lamb's, amplitude, and the time of every zero crossing in exact
/// half periods, so that a frequency that drifts shows.
VerificationRun run_oscillating_drop(const VerificationCase& c, double spacing);

}  // namespace meltproof::solver

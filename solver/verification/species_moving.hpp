// SPDX-License-Identifier: GPL-3.0-or-later
// Species that diffuse in melt that flows.
#pragma once

#include "solver/verification/case.hpp"

namespace meltproof::solver {

/// A stripe of solute in a two-dimensional periodic box of melt that moves as a whole, at `speed`
/// across the stripe and at 0.6 of it along. Uses length, width, z1, z2, diffusivity, time,
/// sound_speed, scheme, operator. Exact: the stripe's solution with periodic images, carried along.
/// Error: L2 norm of C - C_exact over that of C_exact; `extra` holds how much the concentrations
/// differ from those of the same run at rest (Galilean invariance), and the solute's mass.
VerificationRun run_species_moving(const VerificationCase& c, double spacing);

}  // namespace meltproof::solver

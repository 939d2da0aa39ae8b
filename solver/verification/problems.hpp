// SPDX-License-Identifier: GPL-3.0-or-later
// The problems behind the kinds of verification case, each set up in the engine that also runs
// tracks.
#pragma once

#include "solver/verification/case.hpp"

namespace meltproof::solver {

/// A stripe of solute in a two-dimensional box (the paper's Fig. 1). Error: L2 norm of C - C_exact
/// over the L2 norm of C_exact, over all particles.
VerificationRun run_species_stripe(const VerificationCase& c, double spacing);

/// A slab with insulated ends and T = T_0 + A cos(pi x/L) at the start, in three dimensions (a
/// periodic row of particles). Error: L2 norm of T - T_exact over that of T_exact - T_0.
VerificationRun run_conduction_slab(const VerificationCase& c, double spacing);

/// Two slabs of different conductivity that touch in the middle. Error: L2 norm of T - T_exact over
/// the L2 norm of the initial temperature jump.
VerificationRun run_conduction_contact(const VerificationCase& c, double spacing);

/// A solid at its melting temperature, melted from a wall. Error: of the front, relative.
VerificationRun run_stefan(const VerificationCase& c, double spacing);

}  // namespace meltproof::solver

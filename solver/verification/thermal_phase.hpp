// SPDX-License-Identifier: GPL-3.0-or-later
// Melting and freezing fronts with a temperature field on both sides.
#pragma once

#include "solver/verification/case.hpp"

namespace meltproof::solver {

/// Neumann's problem: a half space at T_melt -+ superheat |T_wall - T_melt| whose wall is set to
/// T_wall. `variant` is "melting" (hot wall, cold solid) or "solidification" (cold wall, hot melt).
/// Uses length, diffusivity (of the phase at the wall), stefan, superheat, conductivity_ratio (far
/// phase over phase at the wall), front. Error: of the front's position, relative; `extra` holds
/// the L2 error of the temperature over |T_wall - T_melt|.
VerificationRun run_stefan_two_phase(const VerificationCase& c, double spacing);

}  // namespace meltproof::solver

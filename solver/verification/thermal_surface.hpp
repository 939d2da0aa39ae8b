// SPDX-License-Identifier: GPL-3.0-or-later
// Heat lost through a surface.
#pragma once

#include "solver/verification/case.hpp"

namespace meltproof::solver {

/// A film of 316L of thickness `length`, so well conducting that its temperature is uniform, cools
/// by evaporation alone. Exact: rho h dT/dt c = -m'(T) L_v by adaptive Runge-Kutta. Uses length,
/// diffusivity, temperature, time. Error: of the temperature at `time` over the drop until then;
/// `extra` holds the energy balance, and the Biot number, by which the film differs from a uniform
/// one.
VerificationRun run_evaporative_cooling(const VerificationCase& c, double spacing);

}  // namespace meltproof::solver

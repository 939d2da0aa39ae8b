// SPDX-License-Identifier: GPL-3.0-or-later
// Where the beam's power goes on a powder bed.
#pragma once

#include "solver/verification/case.hpp"

namespace meltproof::solver {

/// A bed of 5 wt% AlSi10Mg grains from drop and roll on a plate of 316L, as particles; the beam
/// passes over it and past its edge at 16 places. Uses power, radius, incidence_angle. Exact:
/// absorbed + reflected + missed = P, and the particles hold what is absorbed. Error: the largest
/// deviation over P. The profile is the absorbed share against the beam's place, its `exact`
/// a(316L).
VerificationRun run_laser_budget(const VerificationCase& c, double spacing);

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// Heat from a beam into a plate that only conducts.
#pragma once

#include "solver/verification/case.hpp"

namespace meltproof::solver {

/// A Gaussian beam that starts at t = 0 and moves over a plate of constant properties without
/// latent heat; the pool is where T is above 1683 K. Half of the plate is computed, with a mirror
/// on the track's line; the other faces are mirrors too, 150 um from the track's ends and `width`,
/// `height` from it. Uses power, absorptivity, radius, speed, time, conductivity, diffusivity.
/// Exact: Eagar and Tsai at the same moment. Error: the largest of those of the pool's length,
/// width and depth; `extra` holds each, and that of the highest temperature at particle centres.
VerificationRun run_moving_source(const VerificationCase& c, double spacing);

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// The flow cases, all run by ClosedFlow with h = spacing. The background pressure of the transport
// velocity is background_in_shear times p0 = rho c^2 in vortices, background_at_rest times
// elsewhere.
#pragma once

#include "solver/verification/case.hpp"

namespace meltproof::solver {

/// Steady flow between plates a `height` apart, periodic over `width`, started from rest and run
/// until `time`. `variant` "couette": the upper plate moves with `speed`; "poiseuille": a body
/// force, one fluid; "two_fluids": the lower half is `viscosity_ratio` times as viscous as the
/// upper. The force is such that one fluid of the upper one's viscosity would reach `speed`, at the
/// Reynolds number `reynolds` = speed height/nu. Error: L2 norm of u - u_exact over that of
/// u_exact, all particles.
VerificationRun run_channel(const VerificationCase& c, double spacing);

/// A column of two fluids, the lower half `density_ratio` times as heavy, between solid floor and
/// ceiling, `height` tall, starts compressed by its own weight, settles until `time`, and then has
/// to stay at rest for `steps` steps. Error: L2 norm of p - p_exact over that of p_exact, both of
/// zero mean (a closed box leaves a constant open). Broken if anything moves faster than 1 % of
/// sqrt(g height) at the end.
VerificationRun run_hydrostatic(const VerificationCase& c, double spacing);

/// Taylor-Green vortices in a periodic unit box, from a relaxed arrangement. Error: amplitude of
/// the exact mode at `time`, sum v . u / sum u . u over the particles, against exp(b t). The
/// largest speed, which Adami et al. (2013) compare, is in `extra`: it carries the noise of single
/// particles, 1 to 3 % and another number for every arrangement to start from, and so hides how
/// fast the mode decays.
VerificationRun run_taylor_green(const VerificationCase& c, double spacing);

/// A square cavity of side 1 whose lid moves with 1. It spins up from rest at four times the
/// spacing for eight times `time`, goes on at twice the spacing and then at the spacing itself for
/// `time` each, from relaxed arrangements. Error: largest deviation from the table on both middle
/// lines, over the lid's speed, read as the mean of the last fifth of the time.
VerificationRun run_cavity(const VerificationCase& c, double spacing);

/// A round drop of `radius` at rest in a lighter fluid, in `dimensions`. Error: pressure difference
/// against (d-1) sigma/R, R from the drop's volume.
VerificationRun run_laplace_drop(const VerificationCase& c, double spacing);

/// A drop driven by the temperature dependence of its surface tension, in a fluid of equal
/// properties with slip walls all around. Error: the speed of its centre, mean over the second half
/// of `time`, against migration_speed().
VerificationRun run_drop_migration(const VerificationCase& c, double spacing);

}  // namespace meltproof::solver

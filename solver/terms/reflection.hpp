// SPDX-License-Identifier: GPL-3.0-or-later
// Light that the metal reflects, followed until it leaves: several hits in a depression absorb more
// than one.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "solver/particles/kernel.hpp"
#include "solver/particles/particles.hpp"
#include "solver/terms/laser.hpp"

namespace meltproof::solver {

/// **Ray tracing** (geometrical optics, specular): the light of each column of the beam meets the
/// particle that irradiate() says, leaves the share a there, and goes on as a ray, mirrored at the
/// normal of the surface, r = d - 2 (d . n) n. Metal is met where a ray comes within
/// `ray_radius` spacings of a particle; its normal there is the direction of -sum grad W, W of 1.5
/// smoothing lengths. At each
/// hit the share a of what is left stays. A ray ends when it leaves the metal's surroundings, or
/// holds less than a thousandth of what it began with; what it then holds is reflected. So a flat
/// surface absorbs a, and a groove of n hits 1 - (1 - a)^n. The absorptivity depends on neither
/// angle nor polarisation: it is the one number that the case gives.
/// @param columns vertical or slanted as for irradiate(); @param absorptivity of a particle, 1;
/// @param power per particle in W, added to; @param ranks that share the metal, collectively: each
/// follows its share of the rays, and power and budget are the same bits on any number of them.
/// @returns the budget, as irradiate().
LaserBudget irradiate_with_reflections(const Laser& laser, double time,
                                       const SurfaceColumns& columns, const Particles& particles,
                                       const QuinticSpline& kernel,
                                       const std::function<double(std::uint32_t)>& absorptivity,
                                       std::vector<double>& power, const Ranks& ranks = {});

/// Metal reaches this far around a particle for a ray, in spacings: just enough that none slips
/// between the particles of a simple cubic lattice (1/sqrt(2)).
constexpr double ray_radius = 0.75;

}  // namespace meltproof::solver

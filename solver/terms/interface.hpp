// SPDX-License-Identifier: GPL-3.0-or-later
// The free surface of the metal, one-sided: there are no particles outside.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "solver/particles/particles.hpp"

namespace meltproof::solver {

/// The colour gradient of a layer whose particles lie `depth` below a plane surface, times the
/// smoothing length: the quintic spline integrated over planes, (1/120) [(3-q)^5 - 6 (2-q)^5 + 15
/// (1-q)^5] with q = depth/h. Half a spacing deep: 0.438; one and a half: 0.0617.
double plane_colour_gradient(double depth_over_h);

/// Its inverse: how deep below the surface a particle lies whose colour gradient times h is
/// `strength`, in smoothing lengths, between 0.25 and 2.
double surface_depth(double strength);

/// Below this colour gradient times h a particle takes no part in the interface: the disorder of a
/// molten interior reaches some 0.02.
inline constexpr double interface_threshold = 0.03;
/// From here on it belongs to the outermost layer. Weaker ones take part only if such a one is
/// within the support.
inline constexpr double outermost_threshold = 0.2;

/// What the interface pass sums up over the neighbours of one particle.
struct InterfaceSums {
  double turn = 0, reach = 0;          ///< sum F (n_i - n_j) . r_t and sum F r_t^2
  std::array<double, 3> difference{};  ///< sum F r_ij (s_i - s_j), s the surface tension
  std::array<double, 6> moment{};      ///< sum F r_ij r_ij^T: xx yy zz xy xz yz
};

/// **Curvature** kappa = (d - 1) turn/reach of the layer that the particle lies in, moved to the
/// surface `depth` above it: kappa/(1 + kappa depth/(d - 1)). Positive for a drop. At most what the
/// spacing can hold: a radius of half a spacing. (Adami et al. 2010; the move: design, solver.md)
/// @param limited set to true where that limit acted.
double surface_curvature(const InterfaceSums& sums, int dimensions, double depth, double spacing,
                         bool& limited);

/// **Gradient along the surface** of the quantity s: M^-1 sum F r_ij (s_i - s_j), exact for a
/// linear s on any set of neighbours that spans space, then projected on the surface. @returns per
/// m.
Vector surface_gradient(const InterfaceSums& sums, const Vector& normal);

}  // namespace meltproof::solver

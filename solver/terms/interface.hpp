// SPDX-License-Identifier: GPL-3.0-or-later
// The free surface of the metal, one-sided: there are no particles outside.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "solver/particles/lanes.hpp"
#include "solver/particles/particles.hpp"

namespace meltproof::solver {

/// The colour gradient `depth` below a plane surface, times the smoothing length: the quintic
/// spline of that many dimensions integrated over the plane, in three W1(q) = (1/60) [P(3) - 6 P(2)
/// + 15 P(1)] with P(n) = n (n-q)^6/6 - (n-q)^7/7, q = depth/h. Half a spacing deep: 0.446 (in two
/// dimensions 0.442), one and a half: 0.0538 (0.0578).
double plane_colour_gradient(double depth_over_h, int dimensions);

/// **How deep below the surface a particle lies**, by its colour gradient.
class SurfaceDepth {
 public:
  explicit SurfaceDepth(int dimensions);

  /// Depth over h below a plane where the colour gradient times h is `strength`; between 0.1 and 2.
  double operator()(double strength) const { return look_up(depth_, strength / step_); }

  /// By how much that falls short per curvature, over h^2. Below a surface of curvature kappa the
  /// colour gradient is W1(s) (1 + kappa s/2) to first order, in two dimensions and in three, so
  /// the depth is s + kappa s W1/(2 |dW1/ds|).
  double per_curvature(double strength) const { return look_up(per_curvature_, strength / step_); }

  /// Which share of the kernel lies within the metal, where the colour gradient times h is
  /// `strength` times the share that the neighbours fill: both grow alike when the metal is
  /// compressed, so their ratio tells the depth and not the density. Between a half and one.
  double covered(double strength_over_sum) const {
    return look_up(covered_, strength_over_sum / ratio_step_);
  }

 private:
  /// Between the entries; `place` counts them.
  static double look_up(const std::vector<double>& table, double place);

  double step_, ratio_step_;
  std::vector<double> depth_, per_curvature_;  // at strength 0, step_, 2 step_, ...
  std::vector<double> covered_;                // at ratio 0, ratio_step_, ...
};

/// Below this colour gradient times h a particle takes no part in the interface: the disorder of a
/// molten interior reaches some 0.02.
inline constexpr double interface_threshold = 0.03;
/// From here on it belongs to the outermost layer.
inline constexpr double outermost_threshold = 0.2;
/// Weaker ones take part only within this distance of an outermost particle, over h: layers lie
/// half, one and a half, two and a half spacings deep, so the second is one away and the third two.
inline constexpr double below_outermost = 1.5;

/// **How much a normal counts in curvatures**: wholly in the outermost layer, not at all where an
/// undisturbed lattice has its second one. There the colour gradient is 0.05 to 0.06 over h and the
/// disorder of a stirred melt 0.02, so normals are off by twenty degrees; with them the forces of a
/// film with ripples feed its motion: it never comes to rest.
/// @param depth below the surface, m.
/// @param outermost depth down to which a particle belongs to the outermost layer, m.
/// @param none depth from which on a normal does not count, m.
template <typename Real>
Real normal_weight(const Real& depth, double outermost, double none) {
  return smaller(Real(1.0), positive_part((none - depth) * (1 / (none - outermost))));
}

/// What the interface pass sums up over the neighbours of one particle.
struct InterfaceSums {
  double turn = 0, reach = 0;          ///< sum F (n_i - n_j) . r_t and sum F r_t^2
  double inset = 0;                    ///< sum F s_j (n_i - n_j) . r_t, s_j the neighbours' depths
  std::array<double, 3> difference{};  ///< sum F r_ij (s_i - s_j), s the surface tension
  std::array<double, 6> moment{};      ///< sum F r_ij r_ij^T: xx yy zz xy xz yz
};

/// **Curvature of the surface** above a particle, (d - 1) turn/(reach + inset). A neighbour at the
/// depth s_j stands for the point of the surface above it, x_j + s_j n_j; r_t + s_j (n_i - n_j)_t
/// leads there along the surface. Exact for a sphere whatever the depths of the neighbours: with
/// r_j = R - s_j, turn sums F r_j sin^2, reach F r_j^2 sin^2. (Adami et al. 2010 for turn/reach,
/// which is the curvature of the layers in which the neighbours lie.) `per_curvature` then allows
/// for the depths being read off a plane, 1/kappa = 1/kappa_0 + per_curvature kappa/(d - 1).
/// Positive for a drop. At most what the spacing can hold: a radius of half a spacing.
/// @param per_curvature SurfaceDepth::per_curvature() h^2, m2.
/// @param limited set to true where that limit acted.
double surface_curvature(const InterfaceSums& sums, int dimensions, double per_curvature,
                         double spacing, bool& limited);

/// **Area of the surface that a particle stands for**, m^(d-1), from `pull` = 2 |grad c| V: summed
/// over a plane's particles that is the plane's area, but layers below a convex surface are smaller
/// than it and 2 |grad c| lacks part of the kernel there. To first order the layers' area is 1 -
/// kappa s of the surface's and |grad c| is 1 + kappa s/2 of the plane's. Without this a sphere of
/// 8 spacings has 8 % too little area. (In the balance of forces both cancel: pressure acts on a
/// particle by the same 2 |grad c| V.)
inline double surface_area(double pull, double curvature, double depth) {
  const double half = curvature * depth / 2;
  return half > 0 ? pull * (1 + half) : pull / (1 - half);
}

/// **Area through which a particle gives off heat**, m^(d-1). Where neighbours are around it,
/// surface_area(). Spray has no surface that a colour gradient could find: a particle alone has
/// none at all, one of a pair an eighteenth of its own. It is a ball of its own volume, open as far
/// as its kernel is empty: 4 pi r^2 alone (exact); in a pair or a thread 13 to 16 % more than a
/// sphere or a cylinder of their volume has. Between 0.35 and 0.5 of the kernel filled (0.48 in the
/// corner of a lattice, 0.61 in its edge, 0.78 in its face) one goes over into the other.
/// @param filled share of the kernel that is filled, the particle itself included.
/// @param alone what the particle itself fills of it.
inline double exposed_area(double surface, double filled, double alone, double volume,
                           int dimensions) {
  constexpr double spray = 0.35, metal = 0.5;
  const double share = std::clamp((metal - filled) / (metal - spray), 0.0, 1.0);
  const double ball = dimensions == 3 ? std::cbrt(36 * std::numbers::pi * volume * volume)
                                      : 2 * std::sqrt(std::numbers::pi * volume);
  return surface + share * (ball * std::min(1.0, (1 - filled) / (1 - alone)) - surface);
}

/// **Which share of a gradient along the surface the missing neighbours would carry**: m = 1 +
/// `spread`/(d - 1) with spread = sum_j V_j F |r_ij - (r_ij . n) n|^2, minus d - 1 where the
/// support is whole; 0.22 in the outermost layer of a lattice. Where m goes from 0.35 to 0.45 the
/// share fades to zero: edges, threads and spray have no surface that a gradient could run along.
inline double missing_support(double spread, int dimensions) {
  constexpr double whole = 0.35, none = 0.45;
  const double missing = std::max(0.0, 1 + spread / (dimensions - 1));
  return missing * std::clamp((none - missing) / (none - whole), 0.0, 1.0);
}

/// **Gradient along the surface** of the quantity s: M^-1 sum F r_ij (s_i - s_j), exact for a
/// linear s on any set of neighbours that spans space, then projected on the surface. @returns per
/// m.
Vector surface_gradient(const InterfaceSums& sums, const Vector& normal);

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

#include "solver/particles/lanes.hpp"

namespace meltproof::solver {

/// **Continuity**: d rho_i/dt = rho_i sum_j V_j (v_i - v_j) . grad_i W_ij. Returns one summand
/// without rho_i, 1/s. (Monaghan 1994)
/// @param slope_over_r (dW/dr)/r in m^-(d+2); @param approach (v_i - v_j) . r_ij in m2 s-1.
template <class T>
T continuity_pair(const T& volume_j, const T& slope_over_r, const T& approach) {
  return volume_j * slope_over_r * approach;
}

/// **Density diffusion**: d rho_i/dt += delta h c sum_j V_j 2 [(rho_i - rho_j) - (g_i + g_j)/2 .
/// r_ij] F_ij, which damps the checkerboard of densities that continuity leaves. g is the corrected
/// gradient of the density: without it the smooth profile under gravity or capillary pressure
/// diffuses too and, since nothing passes the surface, the melt sinks in at the bottom and swells
/// at the top. (Antuono et al. 2010; Molteni & Colagrossi 2009 for g = 0) Returns one summand
/// without delta h c, kg m-3 m-2. Antisymmetric once multiplied by V_i: volume times density is
/// only moved about.
/// @param smooth (g_i + g_j)/2 . r_ij, kg m-3.
template <class T>
T density_diffusion_pair(const T& density_i, const T& density_j, const T& smooth, const T& volume_j,
                         const T& gradient_factor) {
  return 2.0 * volume_j * (density_i - density_j - smooth) * gradient_factor;
}

/// **Density relaxation**: d rho_i/dt += w c/(N h) (rho_sum - rho_i), rho_sum = sum_j m_j W_ij over
/// that of the undisturbed lattice and over the share of the kernel that lies within the metal, see
/// SurfaceDepth::covered(). Continuity alone forgets how many particles there are in a place, and
/// in an outermost layer it hardly notices when they are pressed together or drawn apart. Returns
/// w (rho_sum - rho_i), kg m-3; w falls from one to zero between 0.85 and 0.7 of the density at
/// rest: what is thinner is spray, whose few neighbours say nothing about its density.
inline double density_excess(double summed, double density, double reference) {
  constexpr double whole = 0.85, none = 0.7;
  const double weight = std::clamp((summed / reference - none) / (whole - none), 0.0, 1.0);
  return weight * (summed - density);
}

/// **Repulsion** against clumping under tension at a free surface: an additional pair pressure
/// k max(0, (W_ij/W(d))^4 - 1) in Pa, which vanishes beyond the distance d. With d of a whole
/// spacing it vanishes on the undisturbed lattice, but an undisturbed melt's nearest neighbours are
/// some 0.85 spacings away: there it holds layers together like a yield stress.
/// (after Monaghan 2000, without the factor of the pressure)
/// @param kernel_ratio W_ij/W(d).
template <class T>
T repulsion_pair(const T& kernel_ratio, double strength) {
  const T square = kernel_ratio * kernel_ratio;
  return strength * positive_part(square * square - 1.0);
}

}  // namespace meltproof::solver

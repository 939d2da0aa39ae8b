// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/particles/lanes.hpp"

namespace meltproof::solver {

/// **Viscosity of a pair**: eta_ij = 2 eta_i eta_j/(eta_i + eta_j), Pa s. Harmonic, so that the
/// shear stress is continuous where viscosities jump; zero if either is inviscid. The acceleration
/// is (1/m_i) sum_j (V_i^2 + V_j^2) eta_ij F_ij v_ij. (Morris et al. 1997; Adami et al. 2013)
template <class T>
T viscosity_pair(const T& viscosity_i, const T& viscosity_j) {
  // The floor only keeps 0/0 from arising between two inviscid particles.
  return 2.0 * viscosity_i * (viscosity_j / larger(viscosity_i + viscosity_j, T(1e-300)));
}

/// **Viscosity along the line of a pair**, for a melt with a free surface: one summand of the
/// acceleration is (1/m_i) (V_i^2 + V_j^2) eta_ij S (v_ij . r_ij) r_ij with S = (d/<r^2>)
/// (dW/dr)/r, which this returns, m^-(d+4). Forces along the line keep angular momentum, let a drop
/// turn as a solid without friction, and leave a free surface without traction: the form with v_ij
/// instead dissipates half of what a drop that oscillates should (both after Colagrossi et al.
/// 2011). Its usual weight (d + 2)/(r^2 + (0.1 h)^2) looks at the nearest neighbours too much: on a
/// lattice the shear viscosity is 0.88 of eta along its axes and 1.17 along its diagonals. Weighted
/// by r^2 more it is 1.003 and 1.001 (two dimensions too), and <r^2> = int W r^2 makes
/// the integral exact. (after Monaghan & Gingold 1983)
/// @param slope_over_r (dW/dr)/r in m^-(d+2); @param second_moment <r^2> in m2.
template <class T>
T central_viscosity(const T& slope_over_r, double second_moment, int dimensions) {
  return (dimensions / second_moment) * slope_over_r;
}

/// **Artificial viscosity as a dynamic one** that adds to eta_ij: alpha h c rho_ij / (2 (d + 2)),
/// Pa s, the shear viscosity that the usual artificial viscosity amounts to. (Monaghan 2005)
/// @param density_ij mean density of the pair, kg m-3; @param dimensions d.
template <class T>
T artificial_viscosity(double alpha, double smoothing_length, double sound_speed,
                       const T& density_ij, int dimensions) {
  return (alpha * smoothing_length * sound_speed / (2 * (dimensions + 2))) * density_ij;
}

}  // namespace meltproof::solver

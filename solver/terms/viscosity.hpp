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

/// **Artificial viscosity as a dynamic one** that adds to eta_ij: alpha h c rho_ij / (2 (d + 2)),
/// Pa s, the shear viscosity that the usual artificial viscosity amounts to. (Monaghan 2005)
/// @param density_ij mean density of the pair, kg m-3; @param dimensions d.
template <class T>
T artificial_viscosity(double alpha, double smoothing_length, double sound_speed,
                       const T& density_ij, int dimensions) {
  return (alpha * smoothing_length * sound_speed / (2 * (dimensions + 2))) * density_ij;
}

}  // namespace meltproof::solver

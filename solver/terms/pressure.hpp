// SPDX-License-Identifier: GPL-3.0-or-later
// The equation of state, the pressure between two particles and what a wall particle feels.
#pragma once

#include "solver/particles/lanes.hpp"

namespace meltproof::solver {

/// **Equation of state**: p = p0 (rho/rho0 - 1) + p_add, Pa, with p0 = rho0 c^2 the same for every
/// fluid of a problem, so that pairs across an interface are equally stiff. (Morris et al. 1997;
/// Adami et al. 2013)
template <class T>
T state_pressure(const T& density, const T& reference_density, double stiffness,
                 double added_pressure) {
  return stiffness * (density / reference_density - 1.0) + added_pressure;
}

/// The density at which state_pressure() gives `pressure`, kg m-3.
template <class T>
T state_density(const T& pressure, const T& reference_density, double stiffness,
                double added_pressure) {
  return reference_density * ((pressure - added_pressure) / stiffness + 1.0);
}

/// **Pressure of a pair**: p_ij = (rho_j p_i + rho_i p_j)/(rho_i + rho_j), Pa. Weighted by the
/// other one's density, so that grad p / rho is continuous across an interface. The acceleration is
/// -(1/m_i) sum_j (V_i^2 + V_j^2) p_ij grad_i W. (Adami et al. 2013)
template <class T>
T pressure_pair(const T& pressure_i, const T& density_i, const T& pressure_j, const T& density_j) {
  return (density_j * pressure_i + density_i * pressure_j) / (density_i + density_j);
}

/// **Wall extrapolation**: what a wall particle w collects from the fluid particles j around it.
/// (Adami, Hu & Adams 2012, Eqs. 22 and 27)
template <class T>
struct WallSums {
  T weight = 0;                                      ///< sum W, m^-d
  T pressure = 0;                                    ///< sum p_j W, Pa m^-d
  T moment_x = 0, moment_y = 0, moment_z = 0;        ///< sum rho_j r_wj W, kg m^-2-d
  T velocity_x = 0, velocity_y = 0, velocity_z = 0;  ///< sum v_j W, m s-1 m^-d
};

/// Adds one fluid particle j; `w` is W(r_wj) times one, or times zero if j is no fluid.
template <class T>
void wall_pair(WallSums<T>& sums, const T& w, const T& dx, const T& dy, const T& dz,
               const T& pressure_j, const T& density_j, const T& vx_j, const T& vy_j,
               const T& vz_j) {
  sums.weight += w;
  sums.pressure += w * pressure_j;
  const T weighted = w * density_j;
  sums.moment_x += weighted * dx;
  sums.moment_y += weighted * dy;
  sums.moment_z += weighted * dz;
  sums.velocity_x += w * vx_j;
  sums.velocity_y += w * vy_j;
  sums.velocity_z += w * vz_j;
}

/// p_w = [sum p_j W + (g - a_w) . sum rho_j r_wj W] / sum W, Pa; zero where no fluid is near.
/// @param ax,ay,az g - a_w, m s-2: gravity less the wall's own acceleration.
inline double wall_pressure(const WallSums<double>& sums, double ax, double ay, double az) {
  return sums.weight > 0
             ? (sums.pressure + ax * sums.moment_x + ay * sums.moment_y + az * sums.moment_z) /
                   sums.weight
             : 0;
}

/// v_w = 2 v_s - sum v_j W / sum W, m s-1, axis by axis: the velocity a wall that moves with v_s
/// shows to the viscous force, so that the fluid does not slip; v_s where no fluid is near.
inline double wall_velocity(double own, double velocity_sum, double weight) {
  return weight > 0 ? 2 * own - velocity_sum / weight : own;
}

}  // namespace meltproof::solver

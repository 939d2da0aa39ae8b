// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/multiphase/pair.hpp"
#include "solver/terms/pressure.hpp"
#include "solver/terms/viscosity.hpp"

namespace meltproof::solver {

/// What the momentum pass needs of a particle, packed.
struct alignas(64) FlowRecord {
  double x = void_position, y = void_position, z = void_position;  ///< m
  double volume = 0;                                               ///< m^d
  double density = 0;                                              ///< kg m-3
  double pressure = 0;                                             ///< Pa
  double viscosity = 0;                                            ///< Pa s
  double vx = 0, vy = 0, vz = 0;  ///< v, m s-1; of a wall as wall_velocity() gives it
  double wx = 0, wy = 0, wz = 0;  ///< v~ - v, m s-1; zero of a wall
  double fluid = 0;               ///< 1 for a fluid, 0 for a wall

  static constexpr VectorField<FlowRecord> position() {
    return {&FlowRecord::x, &FlowRecord::y, &FlowRecord::z};
  }
  static constexpr VectorField<FlowRecord> velocity() {
    return {&FlowRecord::vx, &FlowRecord::vy, &FlowRecord::vz};
  }
  static constexpr VectorField<FlowRecord> transport() {
    return {&FlowRecord::wx, &FlowRecord::wy, &FlowRecord::wz};
  }
};

/// The same as numbers of one kind.
template <int D, class T>
struct MomentumState {
  Components<D, T> velocity, transport;
  T volume, density, pressure, viscosity;
};

/// What a particle collects: force in N (per m in two dimensions), and the sum that the background
/// pressure multiplies, m^(d-1).
template <int D, class T>
struct MomentumSums {
  Components<D, T> force{}, background{};
};

/// **Momentum**: m_i dv_i/dt = sum_j (V_i^2 + V_j^2) [-p_ij grad_i W + (A_i + A_j)/2 . grad_i W +
/// eta_ij F_ij v_ij], A = rho v (v~ - v); and sum_j (V_i^2 + V_j^2) grad_i W for the transport
/// velocity. Antisymmetric in the pair. (Adami, Hu & Adams 2013, Eqs. 8 and 13)
template <int D, class T>
void momentum_pair(MomentumSums<D, T>& sums, const PairGeometry<D, T>& pair,
                   const QuinticSpline& kernel, const MomentumState<D, T>& i,
                   const MomentumState<D, T>& j) {
  const T volumes = i.volume * i.volume + j.volume * j.volume;
  const T gradient = volumes * pair.gradient(kernel);
  const T pressure = pressure_pair(i.pressure, i.density, j.pressure, j.density);
  const T friction =
      volumes * viscosity_pair(i.viscosity, j.viscosity) * kernel.gradient_factor(pair.squared);
  const T flux_i = 0.5 * i.density * dot<D>(i.transport, pair.r);
  const T flux_j = 0.5 * j.density * dot<D>(j.transport, pair.r);
  for (std::size_t d = 0; d < D; ++d) {
    sums.force[d] +=
        gradient * (flux_i * i.velocity[d] + flux_j * j.velocity[d] - pressure * pair.r[d]) +
        friction * (i.velocity[d] - j.velocity[d]);
    sums.background[d] += gradient * pair.r[d];
  }
}

}  // namespace meltproof::solver

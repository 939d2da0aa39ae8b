// SPDX-License-Identifier: GPL-3.0-or-later
// The interface between two fluids: colour gradient, curvature and the gradient of the surface
// tension.
#pragma once

#include "solver/multiphase/pair.hpp"

namespace meltproof::solver {

/// What the passes of the interface need of a particle, packed.
struct alignas(64) InterfaceRecord {
  double x = void_position, y = void_position, z = void_position;  ///< m
  double volume = 0;                                               ///< m^d; zero for a wall
  double density = 1;                                              ///< kg m-3
  double side = 0;                ///< 0 and 1 tell the two sides of the interface apart
  double tension = 0;             ///< N m-1
  double nx = 0, ny = 0, nz = 0;  ///< unit normal out of the particle's own side, or zero
  double near = 0;                ///< 1 where the normal is known

  static constexpr VectorField<InterfaceRecord> position() {
    return {&InterfaceRecord::x, &InterfaceRecord::y, &InterfaceRecord::z};
  }
  static constexpr VectorField<InterfaceRecord> normal() {
    return {&InterfaceRecord::nx, &InterfaceRecord::ny, &InterfaceRecord::nz};
  }
};

/// 1 if the two are on different sides, else 0.
template <class T>
T across(const T& side_i, const T& side_j) {
  return (side_i - side_j) * (side_i - side_j);
}

/// **Colour gradient, density-weighted**: grad c_i = (1/V_i) sum_j (V_i^2 + V_j^2) rho_i/(rho_i +
/// rho_j) grad_i W over the j of the other side; points out of the particle's own side. So weighted
/// both sides get the same acceleration. (Adami, Hu & Adams 2010) Returns the factor of r_ij in one
/// summand without 1/V_i, m^(d-2).
template <class T>
T colour_pair(const T& volume_i, const T& density_i, const T& side_i, const T& volume_j,
              const T& density_j, const T& side_j, const T& gradient) {
  // A wall has no volume here: it is on neither side.
  const T counts = across(side_i, side_j) * (volume_i * volume_i + volume_j * volume_j);
  return counts * density_i / (density_i + density_j) * gradient;
}

/// What the curvature is made of.
template <int D, class T>
struct CurvatureSums {
  std::array<Components<D, T>, D> change{};  ///< G = sum V_j (s_ij n_j - n_i) (x) grad_i W, 1/m
  std::array<Components<D, T>, D> moment{};  ///< M = -sum V_j r_ij (x) grad_i W, symmetric
};

/// **Curvature**: kappa_i = tr(G M^-1), the divergence of the normals, over the j near the
/// interface; s_ij = -1 across it, because normals point out of either side. Exact for normals that
/// are linear in space, wherever their neighbours stand. Adami, Hu & Adams (2010) divide by the
/// trace of M instead, which is right while the support is full and 8 to 10 % too high at the rim
/// of the band in which normals are known.
template <int D, class T>
void curvature_pair(CurvatureSums<D, T>& sums, const PairGeometry<D, T>& pair,
                    const Components<D, T>& normal_i, const T& side_i,
                    const Components<D, T>& normal_j, const T& side_j, const T& near_j,
                    const T& volume_j, const T& gradient) {
  const T weight = near_j * volume_j * gradient;
  const T sign = 1.0 - 2.0 * across(side_i, side_j);
  for (std::size_t a = 0; a < D; ++a) {
    for (std::size_t b = 0; b < D; ++b) {
      sums.change[a][b] += weight * (sign * normal_j[a] - normal_i[a]) * pair.r[b];
    }
    for (std::size_t b = a; b < D; ++b) {
      sums.moment[a][b] -= weight * pair.r[a] * pair.r[b];
    }
  }
}

/// What a corrected gradient is made of: grad f = M^-1 g.
template <int D, class T>
struct GradientSums {
  Components<D, T> gradient{};               ///< g = sum V_j (f_j - f_i) grad_i W
  std::array<Components<D, T>, D> moment{};  ///< M = -sum V_j r_ij grad_i W, symmetric
};

/// **Gradient, exact for a linear field**: see GradientSums. (Randles & Libersky 1996)
template <int D, class T>
void gradient_pair(GradientSums<D, T>& sums, const PairGeometry<D, T>& pair, const T& difference,
                   const T& volume_j, const T& gradient) {
  const T weight = volume_j * gradient;
  for (std::size_t a = 0; a < D; ++a) {
    sums.gradient[a] += weight * difference * pair.r[a];
    for (std::size_t b = a; b < D; ++b) {
      sums.moment[a][b] -= weight * pair.r[a] * pair.r[b];
    }
  }
}

}  // namespace meltproof::solver

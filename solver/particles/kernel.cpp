// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/particles/kernel.hpp"

#include <cmath>

namespace meltproof::solver {

void set_lattice_moments(QuinticSpline& kernel, double spacing, int dimensions,
                         LatticeMoments moments) {
  kernel.operator_scale = 1;
  kernel.operator_curvature = 0;
  if (moments == LatticeMoments::none) {
    return;
  }
  const int reach = static_cast<int>(std::ceil(kernel.support() / spacing));
  const int reach_y = dimensions > 1 ? reach : 0, reach_z = dimensions > 2 ? reach : 0;
  const double volume = std::pow(spacing, dimensions);
  // Sums of -V F x^n r^m over the lattice.
  double x2 = 0, x4 = 0, x2_r2 = 0, x4_r2 = 0;
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach_y; j <= reach_y; ++j) {
      for (int k = -reach_z; k <= reach_z; ++k) {
        const double r_squared = spacing * spacing * (i * i + j * j + k * k), x = spacing * i;
        const double weight = -volume * kernel.gradient_factor(r_squared);
        x2 += weight * x * x;
        x4 += weight * x * x * x * x;
        x2_r2 += weight * x * x * r_squared;
        x4_r2 += weight * x * x * x * x * r_squared;
      }
    }
  }
  if (moments == LatticeMoments::fourth) {
    kernel.operator_curvature = x4 / x4_r2;
  }
  kernel.operator_scale = 1 / (x2 - kernel.operator_curvature * x2_r2);
}

QuinticSpline lattice_kernel(double spacing, double smoothing_ratio, int dimensions,
                             LatticeMoments moments) {
  QuinticSpline kernel(smoothing_ratio * spacing, dimensions);
  set_lattice_moments(kernel, spacing, dimensions, moments);
  return kernel;
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/terms/interface.hpp"

#include <Eigen/Dense>

namespace meltproof::solver {

double plane_colour_gradient(double depth_over_h) {
  const auto bracket = [depth_over_h](double end) {
    return std::pow(std::max(0.0, end - depth_over_h), 5);
  };
  return (bracket(3) - 6 * bracket(2) + 15 * bracket(1)) / 120;
}

double surface_depth(double strength) {
  // Monotone, so bisection; forty halvings would be far more than the disorder deserves.
  double shallow = 0.25, deep = 2;
  if (strength >= plane_colour_gradient(shallow)) {
    return shallow;
  }
  if (strength <= plane_colour_gradient(deep)) {
    return deep;
  }
  for (int i = 0; i < 12; ++i) {
    const double middle = (shallow + deep) / 2;
    (plane_colour_gradient(middle) > strength ? shallow : deep) = middle;
  }
  return (shallow + deep) / 2;
}

double surface_curvature(const InterfaceSums& sums, int dimensions, double depth, double spacing,
                         bool& limited) {
  const double directions = dimensions - 1;
  if (sums.reach == 0) {
    return 0;
  }
  const double layer = directions * sums.turn / sums.reach;
  const double most = 2 * directions / spacing;
  const double moved = 1 + layer * depth / directions;
  const double at_surface = moved > 0.1 ? layer / moved : -most;
  limited = limited || std::abs(at_surface) > most || moved <= 0.1;
  return std::clamp(at_surface, -most, most);
}

Vector surface_gradient(const InterfaceSums& sums, const Vector& normal) {
  const auto& m = sums.moment;
  Eigen::Matrix3d matrix;
  matrix << m[0], m[3], m[4], m[3], m[1], m[5], m[4], m[5], m[2];
  const double trace = matrix.trace();
  if (trace == 0) {
    return {};
  }
  // Directions in which the neighbours hardly spread (the missing one of two dimensions, or a thin
  // thread of melt) tell nothing about the gradient there and get none.
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread;
  spread.computeDirect(matrix / trace);
  const Eigen::Vector3d sum(sums.difference[0] / trace, sums.difference[1] / trace,
                            sums.difference[2] / trace);
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    if (spread.eigenvalues()[k] > 0.02) {
      const Eigen::Vector3d axis = spread.eigenvectors().col(k);
      gradient += axis * (axis.dot(sum) / spread.eigenvalues()[k]);
    }
  }
  const Eigen::Vector3d n(normal[0], normal[1], normal[2]);
  gradient -= n * n.dot(gradient);
  return {gradient[0], gradient[1], gradient[2]};
}

}  // namespace meltproof::solver

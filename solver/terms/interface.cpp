// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/terms/interface.hpp"

#include <Eigen/Dense>

#include "solver/particles/kernel.hpp"

namespace meltproof::solver {

double plane_colour_gradient(double depth_over_h, int dimensions) {
  const double q = depth_over_h;
  if (dimensions == 3) {
    const auto part = [q](double end) {
      const double rest = std::max(0.0, end - q), sixth = std::pow(rest, 6);
      return end * sixth / 6 - rest * sixth / 7;
    };
    return (part(3) - 6 * part(2) + 15 * part(1)) / 60;
  }
  // Along the line, by Simpson's rule: the spline is smooth enough for nine digits.
  const QuinticSpline kernel(1, 2);
  const double end = std::sqrt(std::max(0.0, 9 - q * q));
  constexpr int intervals = 200;
  double sum = 0;
  for (int i = 0; i <= intervals; ++i) {
    const double t = end * i / intervals;
    sum += (i == 0 || i == intervals ? 1
            : i % 2 == 1             ? 4
                                     : 2) *
           kernel.value(std::sqrt(q * q + t * t));
  }
  return 2 * sum * end / (3 * intervals);
}

SurfaceDepth::SurfaceDepth(int dimensions) {
  constexpr double shallow = 0.1, deep = 2;
  constexpr std::size_t entries = 512;
  const double strongest = plane_colour_gradient(shallow, dimensions);
  step_ = strongest / (entries - 1);
  for (std::size_t k = 0; k < entries; ++k) {
    const double strength = step_ * static_cast<double>(k);
    double low = shallow, high = deep;
    for (int i = 0; i < 40; ++i) {
      const double middle = (low + high) / 2;
      (plane_colour_gradient(middle, dimensions) > strength ? low : high) = middle;
    }
    const double depth = (low + high) / 2, by = 1e-4;
    const double here = plane_colour_gradient(depth, dimensions);
    const double slope = (plane_colour_gradient(depth + by, dimensions) -
                          plane_colour_gradient(depth - by, dimensions)) /
                         (2 * by);
    depth_.push_back(depth);
    per_curvature_.push_back(depth * here / (2 * std::abs(slope)));
  }
  // Particles stand in layers a spacing apart, the surface half a spacing above the outermost: a
  // sum over them is the integral plus the terms of Euler and Maclaurin's midpoint rule, here to
  // the fourth order. (With the integrals alone the outermost layer of a lattice seems 3.4 % too
  // dense.)
  const auto w = [&](double q) { return plane_colour_gradient(std::abs(q), dimensions); };
  constexpr int fine = 1000;
  constexpr double thin = 3.0 / fine, by = 0.05, second = 1.0 / 24, fourth = 7.0 / 5760;
  std::vector<double> ratio(fine + 1), share(fine + 1);
  double filled = 0.5;
  for (int k = 0; k <= fine; ++k) {
    const double q = thin * k, here = w(q), above = w(q + by), below = w(q - by);
    const double above2 = w(q + 2 * by), below2 = w(q - 2 * by);
    filled += k > 0 ? thin * (w(q - thin) + 4 * w(q - thin / 2) + here) / 6 : 0;
    share[k] = filled - second * (above - below) / (2 * by) +
               fourth * (above2 - 2 * above + 2 * below - below2) / (2 * std::pow(by, 3));
    const double strength =
        here - second * (above - 2 * here + below) / (by * by) +
        fourth * (above2 - 4 * above + 6 * here - 4 * below + below2) / std::pow(by, 4);
    ratio[k] = strength / share[k];
  }
  ratio_step_ = ratio[0] / (entries - 1);
  std::size_t at = fine;
  for (std::size_t k = 0; k < entries; ++k) {
    const double wanted = ratio_step_ * static_cast<double>(k);
    while (at > 0 && ratio[at] < wanted) {
      --at;
    }
    covered_.push_back(share[at]);
  }
}

double SurfaceDepth::look_up(const std::vector<double>& table, double place) {
  const double last = static_cast<double>(table.size() - 1);
  const double at = std::clamp(place, 0.0, last);
  const auto k = static_cast<std::size_t>(std::min(at, last - 1));
  const double share = at - static_cast<double>(k);
  return table[k] + share * (table[k + 1] - table[k]);
}

double surface_curvature(const InterfaceSums& sums, int dimensions, double per_curvature,
                         double spacing, bool& limited) {
  const double directions = dimensions - 1, most = 2 / spacing;
  if (sums.reach == 0) {
    return 0;
  }
  // As 1/R, the same in all directions.
  const double layer = sums.turn / sums.reach, moved = 1 + sums.inset / sums.reach;
  double bend = moved > 0.1 ? layer / moved : -most;
  bend *= 2 / (1 + std::sqrt(1 + 4 * directions * per_curvature * bend * bend));
  limited = limited || std::abs(bend) > most || moved <= 0.1;
  return directions * std::clamp(bend, -most, most);
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

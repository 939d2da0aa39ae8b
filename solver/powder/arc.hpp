// SPDX-License-Identifier: GPL-3.0-or-later
// The path of a rolling sphere's centre is a circle; along it every distance is a sum of a sine and
// a cosine, so that each event has a closed form.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Core>

namespace meltproof::solver {

/// f(angle) = a cos(angle) + b sin(angle) - c.
struct Wave {
  double a = 0, b = 0, c = 0;
  /// The first angle in [0, 2 pi) at which f falls through zero; infinity if there is none.
  double falls() const {
    const double amplitude = std::hypot(a, b);
    if (!(std::abs(c) <= amplitude)) {
      return std::numeric_limits<double>::infinity();
    }
    const double angle = std::atan2(b, a) + std::acos(c / amplitude);
    return angle < 0 ? angle + 2 * std::numbers::pi
                     : (angle >= 2 * std::numbers::pi ? angle - 2 * std::numbers::pi : angle);
  }
  /// The same for an f that is zero at angle 0 up to rounding and does not fall there: the next
  /// fall.
  double falls_again() const {
    const double angle = 2 * std::atan2(std::max(b, 0.0), a);
    return angle;
  }
};

/// centre + radius (u cos(angle) + t sin(angle)): it starts at the sphere's place, with t downhill.
struct Arc {
  Eigen::Vector3d centre{0, 0, 0};
  double radius = 0;
  Eigen::Vector3d u{1, 0, 0}, t{0, 0, -1};  ///< unit vectors
  Eigen::Vector3d at(double angle) const {
    return centre + radius * (std::cos(angle) * u + std::sin(angle) * t);
  }
  /// Distance squared to a fixed point, less `contact` squared, as a wave.
  Wave distance_to(const Eigen::Vector3d& point, double contact) const {
    const Eigen::Vector3d d = centre - point;
    return {2 * radius * d.dot(u), 2 * radius * d.dot(t),
            contact * contact - radius * radius - d.squaredNorm()};
  }
  /// Distance to the plane with unit normal n through `point`, less `contact`.
  Wave distance_to_plane(const Eigen::Vector3d& n, const Eigen::Vector3d& point,
                         double contact) const {
    return {radius * n.dot(u), radius * n.dot(t), contact - n.dot(centre - point)};
  }
};

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/powder/descent.hpp"

#include <Eigen/LU>

namespace meltproof::solver {
namespace {

constexpr double tolerance = 1e-9;  // of the unit vector of gravity

using Eigen::Vector3d;

/// Whether no contact forbids the motion.
bool allowed(const Vector3d& motion, std::span<const Vector3d> directions) {
  for (const Vector3d& e : directions) {
    if (motion.dot(e) < -tolerance) {
      return false;
    }
  }
  return true;
}

}  // namespace

Descent steepest_descent(std::span<const Vector3d> directions) {
  const Vector3d gravity(0, 0, -1);
  const int n = static_cast<int>(directions.size());
  Descent result;
  const auto finish = [&](const Vector3d& motion) {
    result.direction = motion;
    result.rests = motion.norm() < tolerance;
    return result;
  };
  if (allowed(gravity, directions)) {
    return finish(gravity);
  }
  result.count = 1;
  for (int i = 0; i < n; ++i) {
    const Vector3d& e = directions[i];
    const double force = -gravity.dot(e);
    const Vector3d motion = gravity + force * e;
    if (force > 0 && allowed(motion, directions)) {
      result.carrying[0] = i;
      return finish(motion);
    }
  }
  result.count = 2;
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      const Vector3d &e = directions[i], &f = directions[j];
      const double c = e.dot(f), determinant = 1 - c * c;
      if (determinant < tolerance) {
        continue;
      }
      const double first = (-gravity.dot(e) + c * gravity.dot(f)) / determinant;
      const double second = (-gravity.dot(f) + c * gravity.dot(e)) / determinant;
      const Vector3d motion = gravity + first * e + second * f;
      if (first >= 0 && second >= 0 && allowed(motion, directions)) {
        result.carrying = {i, j, 0};
        return finish(motion);
      }
    }
  }
  result.count = 3;
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      for (int k = j + 1; k < n; ++k) {
        Eigen::Matrix3d e;
        e << directions[i], directions[j], directions[k];
        if (std::abs(e.determinant()) < tolerance) {
          continue;
        }
        const Vector3d force = e.inverse() * -gravity;
        if (force.minCoeff() >= 0) {
          result.carrying = {i, j, k};
          return finish(Vector3d::Zero());
        }
      }
    }
  }
  // Only contacts in one plane within rounding come here; the caller drops the sphere anew.
  result.count = 0;
  return finish(Vector3d::Zero());
}

}  // namespace meltproof::solver

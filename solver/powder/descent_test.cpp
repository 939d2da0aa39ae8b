// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/powder/descent.hpp"

#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "solver/powder/random.hpp"

namespace meltproof::solver {
namespace {

using Eigen::Vector3d;

TEST(SteepestDescent, IsGravityLessTheContactForces) {
  using D = std::vector<Vector3d>;
  EXPECT_EQ(steepest_descent(D{}).count, 0);
  const Vector3d side = Vector3d(0.6, 0, 0.8);
  const Descent one = steepest_descent(D{side});
  EXPECT_EQ(one.count, 1);
  EXPECT_NEAR((one.direction - Vector3d(0.48, 0, -0.36)).norm(), 0, 1e-12);
  const Descent valley = steepest_descent(D{Vector3d(0.6, 0.48, 0.64), Vector3d(-0.6, 0.48, 0.64)});
  EXPECT_EQ(valley.count, 2);
  EXPECT_NEAR(valley.direction.x(), 0, 1e-12);
  EXPECT_GT(valley.direction.y(), 0);
  const Descent pocket =
      steepest_descent(D{Vector3d(0.6, 0, 0.8), Vector3d(-0.3, 0.52, 0.8).normalized(),
                         Vector3d(-0.3, -0.52, 0.8).normalized()});
  EXPECT_TRUE(pocket.rests);
  EXPECT_EQ(pocket.count, 3);
}

TEST(SteepestDescent, MeetsTheConditionsOfTheLeastDistanceToTheCone) {
  // Karush, Kuhn and Tucker: allowed, reached by pushes only, and each push across the motion. They
  // are sufficient, because the cone is convex.
  Random random(11);
  int counts[4] = {0, 0, 0, 0};
  for (int sample = 0; sample < 20000; ++sample) {
    std::vector<Vector3d> directions(1 + sample % 6);
    for (Vector3d& e : directions) {
      e = Vector3d(random.normal(), random.normal(), random.normal() + 0.5).normalized();
    }
    const Descent descent = steepest_descent(directions);
    ++counts[descent.count];
    for (const Vector3d& e : directions) {
      EXPECT_GE(descent.direction.dot(e), -1e-8);
    }
    if (descent.count > 0) {
      // The carrying directions, filled up to a basis by vectors across them.
      const Vector3d e = directions[descent.carrying[0]];
      const Vector3d f =
          descent.count > 1 ? directions[descent.carrying[1]] : Vector3d(e.unitOrthogonal());
      const Vector3d g = descent.count > 2 ? directions[descent.carrying[2]] : Vector3d(e.cross(f));
      Eigen::Matrix3d basis;
      basis << e, f, g;
      const Vector3d force = basis.inverse() * (descent.direction + Vector3d::UnitZ());
      for (int k = 0; k < 3; ++k) {
        if (k < descent.count) {
          EXPECT_GE(force(k), -1e-8) << "sample " << sample;
          EXPECT_NEAR(basis.col(k).dot(descent.direction), 0, 1e-8);
        } else {
          EXPECT_NEAR(force(k), 0, 1e-8) << "sample " << sample;
        }
      }
    }
  }
  for (const int count : counts) {
    EXPECT_GT(count, 200);  // all four kinds of motion were seen
  }
}

}  // namespace
}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/powder/drop_and_roll.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/powder/random.hpp"

namespace meltproof::solver {
namespace {

using Eigen::Vector3d;

TEST(DropAndRoll, StopsASphereOverThreeOthersInTheirPocket) {
  // Three equal spheres in contact on the floor: the fourth ends on top at sqrt(8/3) r above them.
  SphereGrid grid(100, 100, 2, false);
  grid.add({{50, 50, 1}, 1});
  grid.add({{52, 50, 1}, 1});
  grid.add({{51, 50 + std::numbers::sqrt3, 1}, 1});
  const Vector3d pocket(51, 50 + 1 / std::numbers::sqrt3, 1 + std::sqrt(8. / 3));
  for (const double x : {50.8, 51.0, 51.3}) {
    const auto settled = drop_and_roll(grid, 1, 1, x, 50.5);
    ASSERT_TRUE(settled);
    EXPECT_NEAR((settled->sphere.centre - pocket).norm(), 0, 1e-9);
  }
}

TEST(DropAndRoll, RollsASphereOffASingleOneOntoTheFloor) {
  SphereGrid grid(100, 100, 2, false);
  grid.add({{50, 50, 1}, 1});
  const auto settled = drop_and_roll(grid, 1, 1, 50.3, 50.4);
  ASSERT_TRUE(settled);
  // It leaves at the widest place, in the direction in which it rolled.
  EXPECT_NEAR(settled->sphere.centre.z(), 1, 1e-12);
  EXPECT_NEAR(settled->sphere.centre.x(), 50 + 2 * 0.6, 1e-9);
  EXPECT_NEAR(settled->sphere.centre.y(), 50 + 2 * 0.8, 1e-9);
  EXPECT_EQ(settled->supports[0], floor_support);
}

TEST(DropAndRoll, RollsOverTwoUnequalSpheresAndStopsAtTheFloor) {
  // Two spheres far enough apart for a small one to fall between them.
  SphereGrid grid(100, 100, 6, false);
  grid.add({{47, 50, 3}, 3});
  grid.add({{53.5, 50, 3}, 3});
  const auto settled = drop_and_roll(grid, 3, 1, 50.2, 50.3);
  ASSERT_TRUE(settled);
  EXPECT_NEAR(settled->sphere.centre.z(), 1, 1e-9);
  for (const Sphere& other : grid.spheres()) {
    EXPECT_GT((settled->sphere.centre - other.centre).norm(), 4 - 1e-9);
  }
}

/// Where a sphere ends that creeps downhill: a small step down, then out of whatever it overlaps.
Vector3d creep(const SphereGrid& grid, double radius, Vector3d place, double step) {
  for (double last = place.z() + 1; last - place.z() > 1e-6 * step && place.z() > radius;) {
    last = place.z();
    place.z() -= step;
    bool overlaps = true;
    for (int sweep = 0; sweep < 200 && overlaps; ++sweep) {
      overlaps = false;
      for (const Sphere& other : grid.spheres()) {
        const Vector3d from = place - other.centre;
        const double contact = radius + other.radius, distance = from.norm();
        if (distance < contact * (1 - 1e-12)) {
          place += from * ((contact - distance) / distance);
          overlaps = true;
        }
      }
    }
  }
  return place;
}

TEST(DropAndRoll, EndsWhereASphereEndsThatCreepsDownhillInSmallSteps) {
  // A heap of unequal spheres, moved far from all walls, and single spheres dropped onto it. Paths
  // fork on edges, where the small steps may take the other side: a few may differ.
  Random random(4);
  SphereGrid heap(12, 12, 4, false), grid(60, 60, 4, false);
  for (int i = 0; i < 25; ++i) {
    const double radius = 1 + random.uniform();
    const double x = radius + random.uniform() * (12 - 2 * radius);
    const double y = radius + random.uniform() * (12 - 2 * radius);
    const auto settled = drop_and_roll(heap, 2, radius, x, y);
    ASSERT_TRUE(settled);
    heap.add(settled->sphere);
    grid.add({settled->sphere.centre + Vector3d(24, 24, 0), radius});
  }
  const int all = 100;
  int same = 0, rolled = 0;
  for (int i = 0; i < all; ++i) {
    const double radius = 0.6 + random.uniform();
    const double x = 24 + 12 * random.uniform(), y = 24 + 12 * random.uniform();
    const auto settled = drop_and_roll(grid, 2, radius, x, y);
    ASSERT_TRUE(settled);
    const Vector3d end = settled->sphere.centre, crept = creep(grid, radius, {x, y, 12}, 2e-3);
    rolled += (end - Vector3d(x, y, end.z())).norm() > 0.2 ? 1 : 0;
    same += (end - crept).norm() < 0.02 ? 1 : 0;
  }
  EXPECT_GT(rolled, all / 2);
  EXPECT_GT(same, 0.97 * all) << "of " << all;
}

}  // namespace
}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes of which it is known how often light hits them: a plate once, a groove of 90 degrees
// twice, one of 60 degrees three times.
#include "solver/terms/reflection.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace meltproof::solver {
namespace {

constexpr double dx = 5e-6;
constexpr double share = 0.4;
const QuinticSpline kernel(dx, 3);

double constant_share(std::uint32_t /*particle*/) { return share; }

/// Metal on a lattice in a box of cells wherever inside(x, y, z) says, m; z is at most zero.
template <class Inside>
Particles metal(std::size_t nx, std::size_t ny, std::size_t nz, const Inside& inside) {
  Particles p;
  p.spacing = dx;
  for (std::size_t k = 0; k < nz; ++k) {
    for (std::size_t j = 0; j < ny; ++j) {
      for (std::size_t i = 0; i < nx; ++i) {
        const Vector at{(static_cast<double>(i) + 0.5) * dx, (static_cast<double>(j) + 0.5) * dx,
                        -(static_cast<double>(k) + 0.5) * dx};
        if (inside(at)) {
          p.add(static_cast<std::int64_t>(p.size()), at, 1e-12, dx * dx * dx, 0, 0, Origin::plate);
        }
      }
    }
  }
  return p;
}

struct Seen {
  LaserBudget budget;
  std::vector<double> power;
};

Seen shine(const Particles& particles, const Laser& laser, const Vector& upper) {
  const auto columns = find_surface(particles, {0, 0, 0}, upper, laser.slant());
  Seen seen;
  seen.power.assign(particles.size(), 0.0);
  seen.budget =
      irradiate_with_reflections(laser, 0, columns, particles, kernel, constant_share, seen.power);
  return seen;
}

/// A groove along x whose walls rise from (y, z) = (middle, bottom) at `steepness`.
Particles groove(double middle, double bottom, double steepness, std::size_t ny, std::size_t nz) {
  return metal(48, ny, nz, [&](const Vector& at) {
    return at[2] < bottom + steepness * std::abs(at[1] - middle);
  });
}

}  // namespace

TEST(Reflection, APlateAbsorbsOnceAndInTheSamePlacesAsWithoutIt) {
  const Particles plate = metal(48, 48, 4, [](const Vector&) { return true; });
  const Laser laser{.power = 100, .radius = 20e-6, .start_x = 120e-6, .y = 120e-6, .exposure = 1};
  const Vector upper{48 * dx, 48 * dx, 0};
  const Seen seen = shine(plate, laser, upper);
  std::vector<double> without(plate.size(), 0.0);
  irradiate(laser, 0, find_surface(plate, {0, 0, 0}, upper), constant_share, without);
  EXPECT_EQ(seen.power, without);
  EXPECT_NEAR(seen.budget.absorbed, 100 * share, 1e-9);
  EXPECT_NEAR(seen.budget.reflected, 100 * (1 - share), 1e-9);
}

TEST(Reflection, AGrooveOfNinetyDegreesAbsorbsTwice) {
  const double middle = 200e-6;
  const Particles walls = groove(middle, -190e-6, 1, 80, 46);
  // On one wall: light goes across, hits the other and leaves upwards.
  const Laser laser{.power = 100, .radius = 15e-6, .start_x = 120e-6, .y = 110e-6, .exposure = 1};
  const Seen seen = shine(walls, laser, {48 * dx, 80 * dx, 0});
  EXPECT_NEAR(seen.budget.absorbed, 100 * (1 - std::pow(1 - share, 2)), 0.5);
  double near_wall = 0, far_wall = 0, height = 0;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    (walls.position[i][1] < middle ? near_wall : far_wall) += seen.power[i];
    height += walls.position[i][1] < middle ? 0 : seen.power[i] * walls.position[i][2];
  }
  EXPECT_NEAR(near_wall, 100 * share, 0.5);
  EXPECT_NEAR(far_wall, 100 * share * (1 - share), 0.5);
  // It crosses on the level: where y = 110 um the wall stands at -100 um.
  EXPECT_NEAR(height / far_wall, -100e-6, 2 * dx);
  EXPECT_NEAR(seen.budget.absorbed + seen.budget.reflected + seen.budget.missed, 100, 1e-9);
}

TEST(Reflection, AGrooveOfSixtyDegreesAbsorbsThrice) {
  const double steepness = std::sqrt(3.0);
  const Particles walls = groove(100e-6, -170e-6, steepness, 40, 46);
  // Down on one wall, square onto the other, and back along the way that it came.
  const Laser laser{.power = 100, .radius = 10e-6, .start_x = 120e-6, .y = 70e-6, .exposure = 1};
  const Seen seen = shine(walls, laser, {48 * dx, 40 * dx, 0});
  EXPECT_NEAR(seen.budget.absorbed, 100 * (1 - std::pow(1 - share, 3)), 2);
}

TEST(Reflection, ASteepWallDoesNotStandInItsOwnLight) {
  // Light that grazes a wall leaves along the steps of its lattice; nothing else is in the way.
  for (const double steepness : {1.5, 2.75, 4.0}) {
    const Particles wall =
        metal(48, 40, 60, [&](const Vector& at) { return at[2] < -steepness * (at[1] - 50e-6); });
    const Laser laser{.power = 100,
                      .radius = 10e-6,
                      .start_x = 120e-6,
                      .y = 50e-6 + 100e-6 / steepness,
                      .exposure = 1};
    const Seen seen = shine(wall, laser, {48 * dx, 40 * dx, 0});
    EXPECT_NEAR(seen.budget.absorbed, (100 - seen.budget.missed) * share, 0.5) << steepness;
  }
}

TEST(Reflection, LightDoesNotHitTheSurfaceThatItLeaves) {
  // Along a steep wall it passes bumps as high as itself, of the lattice and of particles that
  // stand a tenth of a spacing aside, as melt's do. They are the wall; with nothing else around it
  // hits once. Were they taken for something in the way, 5 to 22 % more would be absorbed.
  std::uint64_t state = 1;
  const auto aside = [&](double most) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    return 2 * most * (static_cast<double>(state >> 40U) / static_cast<double>(1U << 24U) - 0.5);
  };
  for (const auto& [steepness, incidence, disorder] :
       {std::array{2.2, 0.5, 0.0}, std::array{4.0, 0.5, 0.0}, std::array{7.0, 0.5, 0.0},
        std::array{3.1, 0.0, 0.1}, std::array{5.3, 0.0, 0.1}, std::array{4.0, 0.5, 0.1}}) {
    Particles wall = metal(48, 40, 60, [steepness = steepness](const Vector& at) {
      return at[2] < -steepness * (at[1] - 50e-6);
    });
    for (Vector& at : wall.position) {
      for (double& x : at) {
        x += aside(disorder) * dx;
      }
    }
    const Laser laser{.power = 100,
                      .radius = 10e-6,
                      .start_x = 120e-6,
                      .y = 50e-6 + 100e-6 / steepness,
                      .exposure = 1,
                      .incidence = incidence};
    const LaserBudget budget = shine(wall, laser, {48 * dx, 40 * dx, 0}).budget;
    EXPECT_NEAR(budget.absorbed, (100 - budget.missed) * share, 0.001 * 100 * share)
        << steepness << " " << incidence << " " << disorder;
  }
}

TEST(Reflection, AMirrorAbsorbsNothingAndABlackBodyEverything) {
  const Particles walls = groove(100e-6, -95e-6, 1, 40, 26);
  const Laser laser{.power = 100, .radius = 10e-6, .start_x = 120e-6, .y = 60e-6, .exposure = 1};
  const auto columns = find_surface(walls, {0, 0, 0}, {48 * dx, 40 * dx, 0});
  for (const double value : {0.0, 1.0}) {
    std::vector<double> power(walls.size(), 0.0);
    const LaserBudget budget = irradiate_with_reflections(
        laser, 0, columns, walls, kernel, [value](std::uint32_t) { return value; }, power);
    EXPECT_NEAR(budget.absorbed, 100 * value, 1e-9);
  }
}

TEST(Reflection, AnInclinedBeamOnAPlateAbsorbsOnce) {
  const Particles plate = metal(60, 60, 4, [](const Vector&) { return true; });
  const Laser laser{.power = 100,
                    .radius = 15e-6,
                    .start_x = 150e-6,
                    .y = 150e-6,
                    .exposure = 1,
                    .incidence = std::numbers::pi / 6};
  EXPECT_NEAR(shine(plate, laser, {60 * dx, 60 * dx, 0}).budget.absorbed, 100 * share, 1e-9);
}

}  // namespace meltproof::solver

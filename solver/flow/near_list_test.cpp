// SPDX-License-Identifier: GPL-3.0-or-later
// The passes of the flow look at a part of the Verlet lists: nobody within the support is missed.
#include <cmath>

#include <gtest/gtest.h>

#include "solver/flow/melt_case.hpp"
#include "solver/step/engine.hpp"
#include "solver/verification/surface_setup.hpp"

namespace meltproof::solver {
namespace {

constexpr double dx = 5e-6;

/// grad c of particle i by its definition, over everybody, m^-1; of volumes as they are now.
Vector colour_gradient(const Engine& engine, std::uint32_t i) {
  const Particles& p = engine.particles();
  Vector sum{};
  for (std::uint32_t j = 0; j < p.size(); ++j) {
    const double x = p.position[i][0] - p.position[j][0], y = p.position[i][1] - p.position[j][1],
                 z = p.position[i][2] - p.position[j][2];
    const double r = std::sqrt(x * x + y * y + z * z);
    if (j != i) {
      const double volume = p.phase[j] == Phase::liquid ? p.mass[j] / p.density[j] : p.volume[j];
      const double weight = volume * engine.kernel().slope(r) / r;
      sum[0] += weight * x;
      sum[1] += weight * y;
      sum[2] += weight * z;
    }
  }
  return sum;
}

}  // namespace

// Half of a drop's particles have passed each other within their lists' skin by then.
TEST(NearList, AStirredDropOnAWallHasTheColourGradientOfAllItsNeighbours) {
  const VerificationCase c = melt_case();
  const Mixture mixture = melt_and_wall(c);
  Particles particles =
      fill_cells(c, dx, mixture, {-12, -12, -4}, {12, 12, 12}, [&](const Vector& at) {
        const double z = at[2] - 3 * dx;
        return at[2] < 0                                              ? Fill::wall
               : at[0] * at[0] + at[1] * at[1] + z * z < 20 * dx * dx ? Fill::melt
                                                                      : Fill::nothing;
      });
  Model model = surface_model(c);
  model.domain.lower = {-20 * dx, -20 * dx, -4 * dx};
  model.domain.upper = {20 * dx, 20 * dx, 20 * dx};
  Engine engine(std::move(particles), mixture, Diffusivity{}, model);
  start_moving(
      engine, [](const Vector&) { return 0.0; },
      [](const Vector& at) {
        return Vector{2 * std::sin(3e5 * at[1]), 2 * std::cos(3e5 * at[0]), 0};
      });
  const std::size_t listed = engine.list_builds();
  const double begun = engine.time();
  while (engine.list_builds() == listed || engine.time() < begun + 2e-6) {
    engine.step(begun + 1e-4);
  }
  // Places and densities as the last call of the passes saw them.
  const Particles& p = engine.particles();
  std::vector<Vector> velocity(p.size());
  std::vector<double> density(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto id = static_cast<std::size_t>(p.identity[i]);
    velocity[id] = p.velocity[i];
    density[id] = p.density[i];
  }
  engine.set_state(velocity, density);
  ASSERT_GT(engine.flow().liquid().size(), 100U);
  for (const std::uint32_t i : engine.flow().liquid()) {
    const Vector found = engine.flow().particle(i).colour, exact = colour_gradient(engine, i);
    for (std::size_t d = 0; d < 3; ++d) {
      // The outermost layer has some 0.3/dx; a hundred summands, each rounded to 1e-16.
      EXPECT_NEAR(found[d], exact[d], 1e-12 / dx) << i;
    }
  }
}

}  // namespace meltproof::solver

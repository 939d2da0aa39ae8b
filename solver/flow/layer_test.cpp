// SPDX-License-Identifier: GPL-3.0-or-later
// Density of layers of melt: at rest, pressed, under gravity.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "solver/flow/free_surface.hpp"
#include "solver/flow/melt_case.hpp"
#include "solver/step/engine.hpp"
#include "solver/verification/surface_setup.hpp"

namespace meltproof::solver {
namespace {

constexpr double dx = 5e-6;

/// Eight layers of melt on a wall, eight by eight periodic, without gravity or surface tension;
/// everything is pressed together along x.
Engine make_layer(double pressed, double relaxation, double diffusion) {
  VerificationCase c = melt_case();
  c.gravity = 0;
  c.surface_tension = 0;
  c.variant = "corrected";
  const Mixture mixture = melt_and_wall(c);
  Particles particles = fill_cells(c, dx, mixture, {0, 0, -4}, {8, 8, 8}, [](const Vector& at) {
    return at[2] < 0 ? Fill::wall : Fill::melt;
  });
  for (Vector& at : particles.position) {
    at[0] *= pressed;
  }
  Model model = surface_model(c);
  model.flow->density_relaxation = relaxation;
  model.flow->density_diffusion = diffusion;
  model.domain.lower = {0, 0, -4 * dx};
  model.domain.upper = {8 * pressed * dx, 8 * dx, 16 * dx};
  model.domain.face[0] = model.domain.face[1] = {Face::periodic, Face::periodic};
  Engine engine(std::move(particles), mixture, Diffusivity{}, model);
  const std::size_t n = engine.particles().size();
  engine.set_state(std::vector<Vector>(n), std::vector<double>(n, c.density / pressed));
  return engine;
}

/// Largest |rho/expected - 1| of the melt above `height`.
double worst_density(const Engine& engine, double expected, double height) {
  double worst = 0;
  for (const std::uint32_t i : engine.flow().liquid()) {
    if (engine.particles().position[i][2] > height) {
      worst = std::max(worst, std::abs(engine.particles().density[i] / expected - 1));
    }
  }
  return worst;
}

}  // namespace

TEST(FreeSurfaceFlow, ALayerAtRestKeepsItsDensityUpToTheSurface) {
  Engine engine = make_layer(1, 10, 0.1);
  while (engine.flow_steps() < 300) {
    engine.step(1);
  }
  EXPECT_LT(worst_density(engine, 7763, -1), 0.005);
}

TEST(FreeSurfaceFlow, APressedLayerKeepsItsDensityUpToTheSurface) {
  Engine engine = make_layer(0.9, 1, 0);
  engine.step(1e-9);
  EXPECT_LT(worst_density(engine, 7763 / 0.9, 4 * dx), 1e-4);
}

TEST(FreeSurfaceFlow, ALayerUnderGravityKeepsTheSpaceItFills) {
  VerificationCase c = melt_case();
  c.gravity = 6e5;
  c.variant = "corrected";
  const Mixture mixture = melt_and_wall(c);
  Particles particles = fill_cells(c, dx, mixture, {0, 0, -4}, {4, 4, 8}, [](const Vector& at) {
    return at[2] < 0 ? Fill::wall : Fill::melt;
  });
  Model model = surface_model(c);
  // Continuity and diffusion alone: a sum over particles would see that these layers start a
  // hundredth too high for their weight.
  model.flow->density_relaxation = 0;
  model.domain.lower = {0, 0, -4 * dx};
  model.domain.upper = {4 * dx, 4 * dx, 16 * dx};
  model.domain.face[0] = model.domain.face[1] = {Face::periodic, Face::periodic};
  Engine engine(std::move(particles), mixture, Diffusivity{}, model);
  start_at_rest(engine, [&](const Vector& at) { return c.density * c.gravity * (8 * dx - at[2]); });
  const auto middle = [&] {
    double sum = 0;
    for (const std::uint32_t i : engine.flow().liquid()) {
      const double z = engine.particles().position[i][2];
      sum += z < 3.2 * dx ? z : 0;
    }
    return sum;
  };
  const double before = middle();
  while (engine.flow_steps() < 1500) {
    engine.step(1);
  }
  EXPECT_NEAR(middle() / before, 1, 0.01);
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// A film at rest: surface tension must not feed motion.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "solver/step/engine.hpp"
#include "solver/verification/surface_setup.hpp"

namespace meltproof::solver {

// Ten rows with every particle moved by up to a tenth of a spacing. What the surface tension gains
// from such disorder must be less than viscosity takes.
TEST(FreeSurfaceFlow, ADisturbedFilmComesToRest) {
  VerificationCase c;
  c.name = "film_test";
  c.density = 7763;
  c.surface_tension = 1.82;
  c.sound_speed = 50;
  c.temperature = 2000;
  c.dimensions = 2;
  c.viscosity = 0.02;
  constexpr double fine = 10e-6 / 3;
  constexpr std::int64_t rows = 10, columns = 24;
  const Mixture mixture = melt_and_wall(c);
  Particles particles =
      fill_cells(c, fine, mixture, {0, -4, 0}, {columns, rows, 1},
                 [](const Vector& at) { return at[1] < 0 ? Fill::wall : Fill::melt; });
  std::mt19937 random(1);
  for (Vector& at : particles.position) {
    for (std::size_t d = 0; d < 2 && at[1] > 0; ++d) {
      at[d] += fine * 0.1 * (static_cast<double>(random()) / 0x1p31 - 1);
    }
  }
  Model model = surface_model(c);
  model.domain.lower = {0, -4 * fine, 0};
  model.domain.upper = {columns * fine, 2 * rows * fine, 0};
  model.domain.face[0] = {Face::periodic, Face::periodic};
  Engine engine(std::move(particles), mixture, Diffusivity{}, model);
  start_at_rest(engine, [](const Vector&) { return 0; });
  double late = 0;
  int steps = 0;
  while (engine.time() < 40e-6) {
    engine.step(40e-6);
    if (engine.time() > 20e-6) {
      late += std::pow(melt_motion(engine).root_mean_square, 2);
      ++steps;
    }
  }
  const double left = std::sqrt(late / steps);
  // Now 0.006 m/s; with the normals of the second row counted 0.03, with its own curvature 0.4.
  EXPECT_LT(left, 0.02);
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/bench/pair_block.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace meltproof::solver {

PairBlock make_pair_block(int side) {
  constexpr double spacing = 10e-6, density = 7000, sound_speed = 50;
  Particles particles;
  particles.spacing = spacing;
  std::mt19937_64 random(1);
  // The standard leaves open how its distributions draw; this is the same everywhere.
  const auto noise = [&] { return static_cast<double>(random() >> 11) * 0x1p-53 - 0.5; };
  const int count = side * side * side;
  for (int k = 0; k < count; ++k) {
    const Vector at{spacing * (k % side + 0.2 * noise()),
                    spacing * (k / side % side + 0.2 * noise()),
                    spacing * (k / side / side + 0.2 * noise())};
    particles.add(k, at, 1, 1, 0, 0, Origin::plate);
  }
  PairBlock block{
      .spacing = spacing, .kernel = QuinticSpline(spacing, 3), .list = {}, .records = {}};
  // The solver's own order of memory, and lists as long as the kernel reaches plus a little skin.
  sort_in_space(particles, 3 * spacing);
  block.list = make_neighbours(particles, {}, 3.06 * spacing);
  block.records.resize(particles.size() + 1);
  const double wave = 2 * std::numbers::pi / (20 * spacing);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vector& at = particles.position[i];
    const double a = std::sin(wave * at[0]), b = std::cos(wave * at[1]), c = std::sin(wave * at[2]);
    const double rho = density * (1 + 0.01 * a * b + 1e-3 * noise());
    const double temperature = 2300 + 400 * b * c + noise();
    PairFields<double>& r = block.records[i];
    r = {.x = at[0],
         .y = at[1],
         .z = at[2],
         .volume = density * spacing * spacing * spacing / rho,
         .vx = 2 * b + 0.1 * noise(),
         .vy = -2 * a + 0.1 * noise(),
         .vz = c + 0.1 * noise(),
         .density = rho,
         .pressure = sound_speed * sound_speed * (rho - density),
         .viscosity = 0.1 * (1 + 0.2 * c),
         .temperature = temperature,
         .conductivity = 10 + 0.01 * temperature,
         .concentration = 0.05 * (1 + a * c) + 1e-3 * noise(),
         .diffusivity = 1e-8 * (1 + 0.5 * b)};
  }
  return block;
}

}  // namespace meltproof::solver

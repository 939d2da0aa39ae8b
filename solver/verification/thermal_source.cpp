// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/verification/thermal_source.hpp"

#include <algorithm>
#include <cmath>

#include "solver/output/melt_pool.hpp"
#include "solver/verification/exact.hpp"
#include "solver/verification/setup.hpp"

namespace meltproof::solver {
namespace {

constexpr double pool_temperature = 1683, start_temperature = 293.15, margin = 150e-6;

struct Plate {
  Particles particles;
  Domain domain;
};

Plate make_plate(const VerificationCase& c, double spacing, double capacity) {
  Plate plate;
  const double track = c.speed * c.time;
  const auto margin_count = static_cast<std::int64_t>(std::ceil(margin / spacing - 1e-9));
  const auto nx = 2 * margin_count + static_cast<std::int64_t>(std::ceil(track / spacing - 1e-9));
  const auto ny = static_cast<std::int64_t>(particles_along(c, c.width, spacing));
  const auto nz = static_cast<std::int64_t>(particles_along(c, c.height, spacing));
  const auto at = [spacing](std::int64_t i) { return static_cast<double>(i) * spacing; };
  plate.domain.lower = {-at(margin_count), 0, -at(nz)};
  plate.domain.upper = {at(nx - margin_count), at(ny), 0};
  plate.domain.face = {
      {{Face::mirror, Face::mirror}, {Face::mirror, Face::mirror}, {Face::mirror, Face::open}}};
  plate.particles.spacing = spacing;
  const double volume = spacing * spacing * spacing;
  for (std::int64_t k = 0; k < nz; ++k) {
    for (std::int64_t j = 0; j < ny; ++j) {
      for (std::int64_t i = 0; i < nx; ++i) {
        plate.particles.add((k * ny + j) * nx + i,
                            {plate.domain.lower[0] + at(i) + spacing / 2, at(j) + spacing / 2,
                             plate.domain.lower[2] + at(k) + spacing / 2},
                            capacity / PlainMatter::specific_heat * volume, volume,
                            PlainMatter::specific_heat * (start_temperature - 298.15), 0,
                            Origin::plate);
      }
    }
  }
  return plate;
}

}  // namespace

VerificationRun run_moving_source(const VerificationCase& c, double spacing) {
  const double capacity = c.conductivity / c.diffusivity;  // rho c
  Material metal = plain_material("plate", c.conductivity, 1e5, 1e5 + 1);
  metal.absorptivity = c.absorptivity;
  Plate plate = make_plate(c, spacing, capacity);
  Model model;
  model.domain = plate.domain;
  model.species = false;
  model.surface_conduction = c.variant != "plain";
  // The columns reach to y = 0 only: the other half of the beam falls on the half that is not
  // computed.
  model.laser = Laser{.power = c.power,
                      .radius = c.radius,
                      .speed = c.speed,
                      .start_x = 0,
                      .y = 0,
                      .exposure = 2 * c.time};
  Engine engine(std::move(plate.particles), Mixture(metal, metal), constant_diffusivity(0), model);
  run_until(engine, c.time);

  const EagarTsai exact{c.absorptivity * c.power, c.radius,      c.speed,
                        c.conductivity,           c.diffusivity, start_temperature};
  const EagarTsai::Pool pool = exact.pool(pool_temperature, c.time);
  const Particles& p = engine.particles();
  std::vector<double> level(p.size());
  std::size_t hottest = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    level[i] = p.temperature[i] - pool_temperature;
    hottest = p.temperature[i] > p.temperature[hottest] ? i : hottest;
  }
  const Extent found = measure_extent(p, engine.neighbours(), level, true);
  const double beam = c.speed * c.time, exact_length = pool.front - pool.tail;
  // Half of the pool is computed: its width is measured from the first column of particles.
  const double width = 2 * (found.width + spacing / 2);
  VerificationRun run = thermal_run(engine);
  const double length_error = found.length / exact_length - 1, width_error = width / pool.width - 1,
               depth_error = found.depth / pool.depth - 1;
  run.error = std::max({std::abs(length_error), std::abs(width_error), std::abs(depth_error)});
  const auto& at = p.position[hottest];
  const double peak = exact(at[0], at[1], -at[2], c.time);
  run.extra = {{"length_um", 1e6 * found.length},
               {"length_exact_um", 1e6 * exact_length},
               {"length_error", length_error},
               {"width_um", 1e6 * width},
               {"width_exact_um", 1e6 * pool.width},
               {"width_error", width_error},
               {"depth_um", 1e6 * found.depth},
               {"depth_exact_um", 1e6 * pool.depth},
               {"depth_error", depth_error},
               {"peak_K", p.temperature[hottest]},
               {"peak_rise_error", (p.temperature[hottest] - peak) / (peak - start_temperature)},
               {"onset_ahead_of_beam_um", 1e6 * (found.onset - beam)},
               {"onset_exact_um", 1e6 * (pool.front - beam)}};
  // The profile is the row of particles next to the track's line at the surface.
  std::vector<std::pair<double, double>> row;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.position[i][1] < spacing && p.position[i][2] > -spacing) {
      row.emplace_back(p.position[i][0], p.temperature[i]);
    }
  }
  std::sort(row.begin(), row.end());
  for (const auto& [x, temperature] : row) {
    run.position.push_back(x);
    run.value.push_back(temperature);
    run.exact.push_back(exact(x, spacing / 2, spacing / 2, c.time));
  }
  return run;
}

}  // namespace meltproof::solver

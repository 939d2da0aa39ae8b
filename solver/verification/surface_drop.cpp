// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/verification/surface_drop.hpp"

#include <cmath>
#include <numbers>

#include "solver/verification/setup.hpp"
#include "solver/verification/surface_setup.hpp"

namespace meltproof::solver {
namespace {

double norm(const Vector& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/// The drop's particles, its mixture, and its radius by volume.
struct Drop {
  Mixture mixture;
  Particles particles;
  double radius = 0;
};

Drop cut_drop(const VerificationCase& c, double spacing) {
  const auto cells = static_cast<std::int64_t>(std::ceil(c.radius / spacing)) + 1;
  Drop drop{.mixture = melt_and_wall(c), .particles = {}};
  drop.particles = fill_lattice(
      c, spacing, drop.mixture, {-cells, -cells, -cells}, {cells, cells, cells},
      [&](const Vector& at) { return norm(at) < c.radius ? Fill::melt : Fill::nothing; });
  const double volume =
      static_cast<double>(drop.particles.size()) * std::pow(spacing, static_cast<int>(c.dimensions));
  drop.radius = c.dimensions == 2 ? std::sqrt(volume / std::numbers::pi)
                                  : std::cbrt(3 * volume / (4 * std::numbers::pi));
  return drop;
}

Model drop_model(const VerificationCase& c) {
  Model model = surface_model(c);
  model.domain.lower = {-3 * c.radius, -3 * c.radius, -3 * c.radius};
  model.domain.upper = {3 * c.radius, 3 * c.radius, 3 * c.radius};
  return model;
}

}  // namespace

VerificationRun run_laplace_free(const VerificationCase& c, double spacing) {
  Drop drop = cut_drop(c, spacing);
  const double radius = drop.radius;
  const double exact = static_cast<double>(c.dimensions - 1) * c.surface_tension / radius;
  Engine engine(std::move(drop.particles), drop.mixture, constant_diffusivity(0), drop_model(c));
  start_at_rest(engine, [&](const Vector&) { return exact; });
  VerificationRun run;
  double sum = 0, speed_sum = 0, mean_speed_sum = 0;
  int counted = 0;
  constexpr int samples = 200;
  for (int i = 1; i <= samples; ++i) {
    run_until(engine, c.time * i / samples);
    const double pressure =
        mean_pressure(engine, [&](const Vector& at) { return norm(at) < radius / 2; });
    run.position.push_back(engine.time());
    run.value.push_back(pressure);
    run.exact.push_back(exact);
    if (2 * i > samples) {
      const FreeFlowState state = free_flow_state(engine);
      sum += pressure;
      speed_sum += state.fastest;
      mean_speed_sum += state.root_mean_square;
      ++counted;
    }
  }
  const double pressure = sum / counted, fastest = speed_sum / counted;
  run.steps = engine.flow_steps();
  run.particles = engine.particles().size();
  run.position_name = "time";
  run.position_unit = "us";
  run.value_name = "pressure";
  run.value_unit = "Pa";
  run.error = std::abs(pressure / exact - 1);
  run.extra = {{"pressure_Pa", pressure},
               {"exact_pressure_Pa", exact},
               {"radius_um", 1e6 * radius},
               {"radius_spacings", radius / spacing},
               {"parasitic_speed_m_per_s", fastest},
               {"parasitic_speed_rms_m_per_s", mean_speed_sum / counted},
               {"parasitic_capillary_number", c.viscosity * fastest / c.surface_tension},
               {"clumped_share", free_flow_state(engine).clumped}};
  return run;
}

}  // namespace meltproof::solver

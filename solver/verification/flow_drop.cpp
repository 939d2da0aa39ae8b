// SPDX-License-Identifier: GPL-3.0-or-later
// Drops in a second fluid.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/verification/flow_exact.hpp"
#include "solver/verification/flow_problems.hpp"
#include "solver/verification/flow_setup.hpp"

namespace meltproof::solver {
namespace {

/// Sets the surface tension everywhere from the temperature.
void set_tension(ClosedFlow& flow, double tension, double slope, double reference) {
  for (std::size_t i = 0; i < flow.particles().size(); ++i) {
    flow.fields().tension[i] = tension + slope * (flow.particles().temperature[i] - reference);
  }
}

double radius_of(const VerificationCase& c, double volume, double share) {
  const double pi = std::numbers::pi;
  return c.dimensions == 2 ? std::sqrt(volume / share / pi)
                           : std::cbrt(volume / share * 3 / (4 * pi));
}

}  // namespace

VerificationRun run_laplace_drop(const VerificationCase& c, double spacing) {
  particles_along(c, c.width, spacing);
  const int dimensions = static_cast<int>(c.dimensions);
  ClosedFlowModel model;
  model.fluids = {{c.density, c.viscosity, 0, 1},
                  {c.density / c.density_ratio, c.viscosity / c.viscosity_ratio, 0, 1}};
  const double exact_radius = c.radius;
  const double guess = (dimensions - 1) * c.surface_tension / exact_radius;
  // 1 % compression by the drop's own pressure, unless a sound speed is given.
  model.stiffness = c.sound_speed > 0 ? c.density * c.sound_speed * c.sound_speed : 100 * guess;
  model.background = background_at_rest * model.stiffness;
  model.interface = true;
  // A quarter (an eighth) of the drop around the origin; planes of symmetry on all sides.
  const Vector lower{0, 0, 0}, upper{c.width, c.width, dimensions == 3 ? c.width : 0};
  const Face third = dimensions == 3 ? Face::mirror : Face::open;
  model.domain = box(lower, upper, {Face::mirror, Face::mirror, third});
  const auto distance = [](const Vector& at) {
    return std::sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]);
  };
  auto start = fill_lattice(dimensions, spacing, lower, upper, model.fluids, [&](const Vector& at) {
    return distance(at) < c.radius ? Placement{Phase::liquid, 0, {}} : Placement{Phase::gas, 1, {}};
  });
  ClosedFlow flow(std::move(start.particles), std::move(start.fluid), model);
  const Particles& particles = flow.particles();
  set_tension(flow, c.surface_tension, 0, 0);
  flow.evaluate();

  VerificationRun run = start_run(flow, {"distance from the centre", "m"}, {"pressure", "Pa"});
  const double reach = flow.kernel().support();
  double inside = 0, outside = 0, radius = 0;
  constexpr int samples = 50;
  run_until(flow, 0.8 * c.time);
  double parasitic = 0, mean_speed = 0;
  for (int sample = 1; sample <= samples; ++sample) {
    run_until(flow, c.time * (0.8 + 0.2 * sample / samples));
    double p_in = 0, n_in = 0, p_out = 0, n_out = 0, volume = 0, speed = 0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const double r = distance(particles.position[i]);
      const Vector& v = particles.velocity[i];
      speed += std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      if (particles.phase[i] == Phase::liquid) {
        volume += particles.mass[i] / particles.density[i];
        p_in += r < c.radius - reach ? flow.pressure()[i] : 0;
        n_in += r < c.radius - reach ? 1 : 0;
      } else {
        p_out += r > c.radius + reach ? flow.pressure()[i] : 0;
        n_out += r > c.radius + reach ? 1 : 0;
      }
    }
    inside += p_in / n_in / samples;
    outside += p_out / n_out / samples;
    radius += radius_of(c, volume, dimensions == 2 ? 0.25 : 0.125) / samples;
    mean_speed += speed / static_cast<double>(particles.size()) / samples;
    parasitic = std::max(parasitic, largest_speed(flow));
  }
  const double exact = (dimensions - 1) * c.surface_tension / radius;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const double r = distance(particles.position[i]);
    show(run, r, flow.pressure()[i] - outside, r < radius ? exact : 0);
  }
  run.error = std::abs((inside - outside) / exact - 1);
  run.steps = flow.steps();
  const Clumping near = clumping(flow);
  run.extra["pressure_difference_error"] = (inside - outside) / exact - 1;
  run.extra["parasitic_capillary_number"] = parasitic * c.viscosity / c.surface_tension;
  run.extra["mean_capillary_number"] = mean_speed * c.viscosity / c.surface_tension;
  run.extra["laplace_number"] =
      c.density * c.surface_tension * 2 * c.radius / (c.viscosity * c.viscosity);
  run.extra["radius_in_spacings"] = radius / spacing;
  run.extra["nearest_neighbour_in_spacings"] = near.nearest;
  run.extra["share_below_half_a_spacing"] = near.share_below_half;
  return run;
}

VerificationRun run_drop_migration(const VerificationCase& c, double spacing) {
  particles_along(c, c.width, spacing);
  particles_along(c, c.height / 2, spacing);
  // Equal properties on both sides; conductivity from a Prandtl number of one.
  ClosedFlowModel model;
  const Fluid fluid{c.density, c.viscosity, c.viscosity, 1};
  model.fluids = {fluid, fluid};
  model.stiffness = c.sound_speed > 0 ? c.density * c.sound_speed * c.sound_speed
                                      : 100 * 2 * c.surface_tension / c.radius;
  model.background = background_at_rest * model.stiffness;
  model.interface = model.heat = true;
  const double half = c.height / 2, reference = c.temperature;
  const Vector lower{0, 0, -half}, upper{c.width, c.width, half};
  model.domain = box(lower, upper, {Face::mirror, Face::mirror, Face::temperature});
  const auto imposed = [&](double z) { return reference + c.temperature_gradient * z; };
  model.domain.temperature[2] = {imposed(-half), imposed(half)};
  auto start = fill_lattice(3, spacing, lower, upper, model.fluids, [&](const Vector& at) {
    const double r = std::sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]);
    return r < c.radius ? Placement{Phase::liquid, 0, {}} : Placement{Phase::gas, 1, {}};
  });
  for (std::size_t i = 0; i < start.particles.size(); ++i) {
    start.particles.temperature[i] = imposed(start.particles.position[i][2]);
  }
  ClosedFlow flow(std::move(start.particles), std::move(start.fluid), model);
  const Particles& particles = flow.particles();
  set_tension(flow, c.surface_tension, c.surface_tension_slope, reference);
  flow.evaluate();
  const double exact =
      migration_speed(c.surface_tension_slope, c.temperature_gradient, c.radius, c.viscosity,
                      c.viscosity, fluid.conductivity, fluid.conductivity);
  VerificationRun run = start_run(flow, {"time", "s"}, {"speed of the drop", "m s-1"});
  const auto drop_mean = [&](const auto& value) {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      if (particles.phase[i] == Phase::liquid) {
        sum += value(i);
        count += 1;
      }
    }
    return sum / count;
  };
  const auto height = [&] {
    return drop_mean([&](std::size_t i) { return particles.position[i][2]; });
  };
  constexpr int rows = 40;
  double before = height();
  const double first = before;
  for (int row = 1; row <= rows; ++row) {
    const double until = c.time * row / rows;
    while (flow.time() < until * (1 - 1e-9)) {
      flow.advance(std::min(flow.stable_step(), until - flow.time()));
      set_tension(flow, c.surface_tension, c.surface_tension_slope, reference);
    }
    // Towards the hot side; the centre's own way, so that no particle's noise enters.
    const double now = height(), speed = (now - before) / (c.time / rows);
    before = now;
    show(run, flow.time(), speed, exact);
  }
  double mean = 0;
  constexpr int last = rows / 2;
  for (int row = rows - last; row < rows; ++row) {
    mean += run.value[static_cast<std::size_t>(row)] / last;
  }
  run.error = std::abs(mean / exact - 1);
  run.steps = flow.steps();
  run.extra["speed_error"] = mean / exact - 1;
  run.extra["way_in_radii"] = (before - first) / c.radius;
  run.extra["reynolds_number"] = c.density * exact * c.radius / c.viscosity;
  run.extra["marangoni_number"] = exact * c.radius * c.density / fluid.conductivity;
  run.extra["radius_in_spacings"] = c.radius / spacing;
  run.extra["nearest_neighbour_in_spacings"] = clumping(flow).nearest;
  return run;
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// Flows whose exact solution is a profile between two plates.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"
#include "solver/verification/flow_exact.hpp"
#include "solver/verification/flow_problems.hpp"
#include "solver/verification/flow_setup.hpp"

namespace meltproof::solver {
namespace {

/// Layers of wall particles: the support of the kernel.
constexpr double wall_layers = 3;

}  // namespace

VerificationRun run_channel(const VerificationCase& c, double spacing) {
  particles_along(c, c.height / 2, spacing);
  particles_along(c, c.width, spacing);
  const bool couette = c.variant == "couette", two = c.variant == "two_fluids";
  if (!couette && !two && c.variant != "poiseuille") {
    throw InputError(
        fmt::format("{}: variant \"{}\": expected \"couette\", \"poiseuille\" or \"two_fluids\"",
                    c.name, c.variant));
  }
  const double viscosity = c.density * c.speed * c.height / c.reynolds;
  const double acceleration =
      couette ? 0 : 8 * viscosity / c.density * c.speed / (c.height * c.height);
  const double ratio = two ? c.viscosity_ratio : 1;
  ClosedFlowModel model;
  model.fluids = {{c.density, ratio * viscosity, 0, 1}, {c.density, viscosity, 0, 1}};
  const double sound = c.sound_speed > 0 ? c.sound_speed : 10 * c.speed;
  set_stiffness(model, c.density, sound, background_at_rest);
  model.gravity = {acceleration, 0, 0};
  const double wall = wall_layers * spacing;
  const Vector lower{0, -wall, 0}, upper{c.width, c.height + wall, 0};
  model.domain = box(lower, upper, {Face::periodic, Face::open, Face::open});
  auto start = fill_lattice(2, spacing, lower, upper, model.fluids, [&](const Vector& at) {
    const bool above = at[1] > c.height;
    return at[1] < 0 || above ? Placement{Phase::solid, -1, {above && couette ? c.speed : 0, 0, 0}}
                              : Placement{Phase::liquid, at[1] < c.height / 2 ? 0 : 1, {}};
  });
  ClosedFlow flow(std::move(start.particles), std::move(start.fluid), model);
  run_until(flow, c.time);

  const double force = c.density * acceleration;
  const ShearFlow exact(
      {{c.height / 2, ratio * viscosity, force}, {c.height / 2, viscosity, force}},
      couette ? c.speed : 0);
  VerificationRun run = start_run(flow, {"height", "m"}, {"speed along the plates", "m s-1"});
  double deviation = 0, norm = 0;
  for (std::size_t i = 0; i < flow.particles().size(); ++i) {
    if (flow.particles().phase[i] == Phase::solid) {
      continue;
    }
    const double y = flow.particles().position[i][1], u = flow.particles().velocity[i][0];
    deviation += std::pow(u - exact(y), 2);
    norm += std::pow(exact(y), 2);
    show(run, y, u, exact(y));
  }
  run.error = std::sqrt(deviation / norm);
  run.steps = flow.steps();
  const Clumping near = clumping(flow);
  run.extra["nearest_neighbour_in_spacings"] = near.nearest;
  return run;
}

VerificationRun run_hydrostatic(const VerificationCase& c, double spacing) {
  particles_along(c, c.height / 2, spacing);
  particles_along(c, c.width, spacing);
  const double light = c.density / c.density_ratio, weight = c.gravity;
  const double speed = std::sqrt(weight * c.height);
  ClosedFlowModel model;
  const double viscosity = c.density * speed * c.height / c.reynolds;
  model.fluids = {{c.density, viscosity, 0, 1}, {light, viscosity / c.density_ratio, 0, 1}};
  const double sound = c.sound_speed > 0 ? c.sound_speed : 10 * speed;
  set_stiffness(model, c.density, sound, background_at_rest);
  model.gravity = {0, -weight, 0};
  const double wall = wall_layers * spacing, half = c.height / 2;
  // Pressure over that at the interface, and less its mean: the mean compression is none.
  const auto raw = [&](double y) { return -weight * (y < half ? c.density : light) * (y - half); };
  const double mean = weight * (c.density - light) * half / 4;
  const auto exact = [&](double y) { return raw(y) - mean; };
  // How far a particle of the lattice sinks: the integral of p/p0 above the floor.
  const auto sunk = [&](double y) {
    const auto antiderivative = [&](double s) {
      return -weight * (s < half ? c.density : light) * (s - half) * (s - half) / 2;
    };
    return (antiderivative(y) - antiderivative(0) - mean * y) / model.stiffness;
  };
  const Vector lower{0, -wall, 0}, upper{c.width, c.height + wall, 0};
  model.domain = box(lower, upper, {Face::periodic, Face::open, Face::open});
  auto start = fill_lattice(2, spacing, lower, upper, model.fluids, [&](const Vector& at) {
    return at[1] < 0 || at[1] > c.height
               ? Placement{Phase::solid, -1, {}}
               : Placement{at[1] < half ? Phase::liquid : Phase::gas, at[1] < half ? 0 : 1, {}};
  });
  for (std::size_t i = 0; i < start.particles.size(); ++i) {
    if (start.particles.phase[i] != Phase::solid) {
      double& y = start.particles.position[i][1];
      y -= sunk(y);
    }
  }
  ClosedFlow flow(std::move(start.particles), std::move(start.fluid), model);
  run_until(flow, c.time);
  double fastest = 0;
  for (long long k = 0; k < c.steps; ++k) {
    flow.advance(flow.stable_step());
    fastest = std::max(fastest, largest_speed(flow));
  }

  VerificationRun run = start_run(flow, {"height", "m"}, {"pressure", "Pa"});
  double mean_value = 0, mean_exact = 0, count = 0;
  for (std::size_t i = 0; i < flow.particles().size(); ++i) {
    if (flow.particles().phase[i] == Phase::solid) {
      continue;
    }
    const double y = flow.particles().position[i][1];
    show(run, y, flow.pressure()[i], exact(y));
    mean_value += flow.pressure()[i];
    mean_exact += exact(y);
    count += 1;
  }
  double deviation = 0, norm = 0;
  for (std::size_t k = 0; k < run.value.size(); ++k) {
    run.value[k] += (mean_exact - mean_value) / count;
    deviation += std::pow(run.value[k] - run.exact[k], 2);
    norm += std::pow(run.exact[k], 2);
  }
  run.error = std::sqrt(deviation / norm);
  run.steps = flow.steps();
  const double last = largest_speed(flow) / speed;
  run.extra["speed_at_the_end_over_sqrt_gH"] = last;
  run.extra["largest_speed_while_at_rest_over_sqrt_gH"] = fastest / speed;
  run.extra["duration_over_sqrt_H_over_g"] = flow.time() * speed / c.height;
  if (!(last < 0.01)) {
    run.broken.push_back(fmt::format(
        "the column is not at rest: after {} steps a particle moves with {:.3g} of sqrt(g H), "
        "expected below 0.01",
        flow.steps(), last));
  }
  return run;
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// Vortices: one that decays exactly, one that a lid drives.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "solver/verification/flow_exact.hpp"
#include "solver/verification/flow_problems.hpp"
#include "solver/verification/flow_setup.hpp"

namespace meltproof::solver {

VerificationRun run_taylor_green(const VerificationCase& c, double spacing) {
  particles_along(c, 1, spacing);
  const double k = 2 * std::numbers::pi;
  ClosedFlowModel model;
  model.fluids = {{1, 1 / c.reynolds, 0, 1}};
  const double sound = c.sound_speed > 0 ? c.sound_speed : 10;
  set_stiffness(model, 1, sound, background_in_shear);
  model.density_relaxation = relaxation_in_shear;
  model.domain = box({0, 0, 0}, {1, 1, 0}, {Face::periodic, Face::periodic, Face::open});
  auto start = fill_lattice(2, spacing, {0, 0, 0}, {1, 1, 0}, model.fluids,
                            [](const Vector&) { return Placement{}; });
  ClosedFlow flow(std::move(start.particles), std::move(start.fluid), model);
  const auto exact = [k](const Vector& at) {
    return Vector{-std::cos(k * at[0]) * std::sin(k * at[1]),
                  std::sin(k * at[0]) * std::cos(k * at[1]), 0};
  };
  // From the lattice itself the particles would first pile up along the streamlines that run into
  // the stagnation points, in exact symmetry, until that arrangement breaks down.
  relax(flow, 0.4, 1000);
  Particles& particles = flow.particles();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    particles.velocity[i] = exact(particles.position[i]);
  }
  flow.evaluate();
  const double began = flow.time();
  const std::size_t before = flow.steps();
  // How much of the exact mode is in the flow, and all its motion with the particles' noise.
  struct Reading {
    double amplitude = 0, rms = 0;
  };
  const auto read = [&] {
    double along = 0, mode = 0, energy = 0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const Vector u = exact(particles.position[i]), &v = particles.velocity[i];
      along += u[0] * v[0] + u[1] * v[1];
      mode += u[0] * u[0] + u[1] * u[1];
      energy += v[0] * v[0] + v[1] * v[1];
    }
    return Reading{along / mode, std::sqrt(energy / mode)};
  };
  VerificationRun run = start_run(flow, {"time", "s"}, {"amplitude of the vortices", "m s-1"});
  const double rate = taylor_green_rate(c.reynolds);
  constexpr int rows = 20;
  for (int row = 1; row <= rows; ++row) {
    run_until(flow, began + c.time * row / rows);
    const double time = flow.time() - began;
    show(run, time, read().amplitude, std::exp(rate * time));
  }
  const double last = run.exact.back();
  run.error = std::abs(run.value.back() / last - 1);
  run.steps = flow.steps() - before;
  run.extra["amplitude_error"] = run.value.back() / last - 1;
  run.extra["rms_speed_error"] = read().rms / last - 1;
  run.extra["largest_speed_error"] = largest_speed(flow) / last - 1;
  run.extra["nearest_neighbour_in_spacings"] = clumping(flow).nearest;
  return run;
}

namespace {

constexpr double wall_layers = 3;

/// A cavity, filled at rest or with the flow of a coarser one.
ClosedFlow make_cavity(const VerificationCase& c, double spacing, const ClosedFlow* coarse) {
  ClosedFlowModel model;
  model.fluids = {{1, 1 / c.reynolds, 0, 1}};
  const double sound = c.sound_speed > 0 ? c.sound_speed : 10;
  set_stiffness(model, 1, sound, background_in_shear);
  model.density_relaxation = relaxation_in_shear;
  const double wall = wall_layers * spacing;
  const Vector lower{-wall, -wall, 0}, upper{1 + wall, 1 + wall, 0};
  model.domain = box(lower, upper, {Face::open, Face::open, Face::open});
  auto start = fill_lattice(2, spacing, lower, upper, model.fluids, [&](const Vector& at) {
    if (at[1] > 1) {
      return Placement{Phase::solid, -1, {1, 0, 0}};
    }
    const bool inside = at[0] > 0 && at[0] < 1 && at[1] > 0;
    return inside ? Placement{} : Placement{Phase::solid, -1, {}};
  });
  ClosedFlow flow(std::move(start.particles), std::move(start.fluid), std::move(model));
  // A lattice would break down on the way and brake the flow, see run_taylor_green().
  relax(flow, 0.4, 500);
  Particles& particles = flow.particles();
  for (std::size_t i = 0; coarse != nullptr && i < particles.size(); ++i) {
    for (std::size_t d = 0; d < 2 && particles.phase[i] == Phase::liquid; ++d) {
      particles.velocity[i][d] = read_at(*coarse, particles.position[i], [&](std::size_t j) {
        return coarse->particles().velocity[j][d];
      });
    }
  }
  flow.evaluate();
  return flow;
}

}  // namespace

VerificationRun run_cavity(const VerificationCase& c, double spacing) {
  particles_along(c, 1, spacing);
  const CavityReference table = cavity_reference(c.reynolds);
  // The flow spins up where time is cheap: each finer level only has to take up what is new to it.
  std::optional<ClosedFlow> flow;
  const auto go_on = [&](double level_spacing, double span) {
    flow.emplace(make_cavity(c, level_spacing, flow ? &*flow : nullptr));
    return flow->time() + span;
  };
  for (const double factor : {4.0, 2.0}) {
    const double coarse = factor * spacing;
    if (coarse <= 0.04 && std::abs(1 / coarse - std::round(1 / coarse)) < 1e-6) {
      const double end = go_on(coarse, (flow ? 4 : 8) * c.time);
      run_until(*flow, end);
    }
  }
  const double end = go_on(spacing, (flow ? 1 : 8) * c.time);
  std::vector<double> u(table.y.size()), v(table.x.size());
  run_until(*flow, end - 0.2 * c.time);
  constexpr int samples = 40;
  for (int sample = 1; sample <= samples; ++sample) {
    run_until(*flow, end - 0.2 * c.time * (1 - static_cast<double>(sample) / samples));
    for (std::size_t k = 0; k < u.size(); ++k) {
      u[k] += read_at(*flow, {0.5, table.y[k], 0},
                      [&](std::size_t i) { return flow->particles().velocity[i][0]; }) /
              samples;
      v[k] += read_at(*flow, {table.x[k], 0.5, 0},
                      [&](std::size_t i) { return flow->particles().velocity[i][1]; }) /
              samples;
    }
  }
  VerificationRun run =
      start_run(*flow, {"place on the middle line (u on the vertical first, then v)", "m"},
                {"speed", "m s-1"});
  run.steps = flow->steps();
  double worst_u = 0, worst_v = 0;
  for (std::size_t k = 0; k < u.size(); ++k) {
    show(run, table.y[k], u[k], table.u[k]);
    worst_u = std::max(worst_u, std::abs(u[k] - table.u[k]));
  }
  for (std::size_t k = 0; k < v.size(); ++k) {
    show(run, table.x[k], v[k], table.v[k]);
    worst_v = std::max(worst_v, std::abs(v[k] - table.v[k]));
  }
  run.error = std::max(worst_u, worst_v);
  run.extra["largest_deviation_u"] = worst_u;
  run.extra["largest_deviation_v"] = worst_v;
  run.extra["nearest_neighbour_in_spacings"] = clumping(*flow).nearest;
  return run;
}

}  // namespace meltproof::solver

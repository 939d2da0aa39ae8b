// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/verification/species_moving.hpp"

#include <algorithm>
#include <cmath>

#include "solver/verification/exact.hpp"
#include "solver/verification/setup.hpp"

namespace meltproof::solver {
namespace {

Engine make_engine(const VerificationCase& c, double spacing, double speed) {
  const Material melt = plain_material("melt", 1, 1, 2);
  const Mixture mixture(melt, melt);
  Particles particles = make_stripe(c, spacing);
  Model model;
  model.domain.upper = {c.width, c.length, 0};
  model.domain.face = {{{Face::periodic, Face::periodic},
                        {Face::periodic, Face::periodic},
                        {Face::open, Face::open}}};
  set_species(model, c);
  FlowSettings flow;
  flow.sound_speed = c.sound_speed;
  flow.gravity = {};
  flow.surface_tension = flow.marangoni = flow.recoil = false;
  model.flow = flow;
  const std::size_t count = particles.size();
  Engine engine(std::move(particles), mixture, constant_diffusivity(c.diffusivity), model);
  engine.set_state(std::vector<Vector>(count, {0.6 * speed, speed, 0}),
                   std::vector<double>(count, PlainMatter::density));
  return engine;
}

std::vector<double> by_identity(const Particles& p) {
  std::vector<double> result(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    result[static_cast<std::size_t>(p.identity[i])] = p.concentration[i];
  }
  return result;
}

}  // namespace

VerificationRun run_species_moving(const VerificationCase& c, double spacing) {
  Engine engine = make_engine(c, spacing, c.speed);
  const double solute = engine.total_additive_mass();
  run_until(engine, c.time);
  Engine resting = make_engine(c, spacing, 0);
  run_until(resting, c.time);

  const Particles& p = engine.particles();
  const double spread = std::sqrt(4 * c.diffusivity * c.time), moved = c.speed * c.time;
  VerificationRun run, all;
  run.steps = engine.steps();
  run.particles = p.size();
  run.value_name = "concentration";
  std::vector<std::array<double, 3>> row;
  double slowest = c.speed;
  for (std::size_t i = 0; i < p.size(); ++i) {
    // Back in the stripe's frame, within the box.
    const double z = p.position[i][1] - moved;
    const double there = z - c.length * std::floor(z / c.length);
    all.value.push_back(p.concentration[i]);
    all.exact.push_back(periodic_stripe(there, c.z1, c.z2, c.length, spread));
    slowest = std::min(slowest, p.velocity[i][1]);
    if (static_cast<std::size_t>(p.identity[i]) % particles_along(c, c.width, spacing) == 0) {
      row.push_back({there, all.value.back(), all.exact.back()});
    }
  }
  std::sort(row.begin(), row.end());
  for (const auto& [position, value, exact] : row) {
    run.position.push_back(position);
    run.value.push_back(value);
    run.exact.push_back(exact);
  }
  run.error = l2_error(all);
  const auto moving = by_identity(p), still = by_identity(resting.particles());
  double difference = 0;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    difference = std::max(difference, std::abs(moving[i] - still[i]));
  }
  const double lost = std::abs(engine.total_additive_mass() / solute - 1);
  run.extra = {{"galilean_difference", difference},
               {"solute_mass_error", lost},
               {"boxes_crossed", moved / c.length},
               {"slowest_over_speed", slowest / c.speed}};
  if (!(difference <= 1e-3)) {
    run.broken.emplace_back("the stripe that moves differs from the one at rest by more than 1e-3");
  }
  if (!(lost <= 1e-10)) {
    run.broken.emplace_back("the solute's mass changed by more than 1e-10");
  }
  return run;
}

}  // namespace meltproof::solver

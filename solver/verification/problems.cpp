// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/verification/problems.hpp"

#include <cmath>
#include <numbers>

#include "solver/verification/exact.hpp"
#include "solver/verification/setup.hpp"

namespace meltproof::solver {

namespace {

constexpr double density = PlainMatter::density, specific_heat = PlainMatter::specific_heat;

}  // namespace

VerificationRun run_species_stripe(const VerificationCase& c, double spacing) {
  const Material melt = plain_material("melt", 1, 1, 2);
  Model model;
  model.domain.upper = {c.width, c.length, 0};
  model.domain.face = {
      {{Face::periodic, Face::periodic}, {Face::mirror, Face::mirror}, {Face::open, Face::open}}};
  set_species(model, c);
  Engine engine(make_stripe(c, spacing), Mixture(melt, melt), constant_diffusivity(c.diffusivity),
                model);
  run_until(engine, c.time);

  const StripeSolution solution{c.z1, c.z2, c.length};
  const double spread = std::sqrt(4 * c.diffusivity * c.time);
  VerificationRun run;
  run.value_name = "concentration";
  run.steps = engine.steps();
  run.particles = engine.particles().size();
  VerificationRun all;
  for (std::size_t i = 0; i < engine.particles().size(); ++i) {
    const auto& at = engine.particles().position[i];
    all.value.push_back(engine.particles().concentration[i]);
    all.exact.push_back(solution(at[1], spread));
  }
  run.error = l2_error(all, 0);
  // The profile is the row of particles nearest to x = 0, in order of z, which identity gives.
  const std::size_t nx = particles_along(c, c.width, spacing),
                    nz = particles_along(c, c.length, spacing);
  run.position.resize(nz);
  run.value.resize(nz);
  run.exact.resize(nz);
  for (std::size_t i = 0; i < engine.particles().size(); ++i) {
    const auto id = static_cast<std::size_t>(engine.particles().identity[i]);
    if (id % nx == 0) {
      run.position[id / nx] = engine.particles().position[i][1];
      run.value[id / nx] = all.value[i];
      run.exact[id / nx] = all.exact[i];
    }
  }
  return run;
}

VerificationRun run_conduction_slab(const VerificationCase& c, double spacing) {
  const Material slab = plain_material("slab", c.diffusivity * density * specific_heat, 900, 901);
  const double middle = 500, amplitude = 100;
  const auto mode = [&](double x) { return std::cos(std::numbers::pi * x / c.length); };
  Particles particles = make_row(particles_along(c, c.length, spacing), spacing);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    particles.enthalpy[i] =
        specific_heat * (middle + amplitude * mode(particles.position[i][0]) - 298.15);
  }
  Model model;
  model.domain = row_domain(c.length, spacing, Face::mirror, Face::mirror);
  model.species = false;
  Engine engine(std::move(particles), Mixture(slab, slab), constant_diffusivity(0), model);
  run_until(engine, c.time);
  VerificationRun run = thermal_run(engine);
  run.value_name = "temperature minus mean";
  const double decay = std::exp(-c.diffusivity * std::pow(std::numbers::pi / c.length, 2) * c.time);
  for (std::size_t i = 0; i < engine.particles().size(); ++i) {
    const double x = engine.particles().position[i][0];
    run.position.push_back(x);
    run.value.push_back(engine.particles().temperature[i] - middle);
    run.exact.push_back(amplitude * decay * mode(x));
  }
  run.error = l2_error(run, 0);
  return run;
}

VerificationRun run_conduction_contact(const VerificationCase& c, double spacing) {
  const double left = c.diffusivity * density * specific_heat, right = left * c.conductivity_ratio;
  const Mixture mixture(plain_material("left", left, 900, 901),
                        plain_material("right", right, 900, 901));
  const ContactSolution solution{600,   400,           left,
                                 right, c.diffusivity, c.diffusivity * c.conductivity_ratio};
  Particles particles = make_row(particles_along(c, c.length, spacing), spacing);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const bool on_left = particles.position[i][0] < c.length / 2;
    particles.concentration[i] = on_left ? 0 : 1;
    particles.enthalpy[i] =
        specific_heat *
        ((on_left ? solution.temperature_left : solution.temperature_right) - 298.15);
  }
  Model model;
  model.domain = row_domain(c.length, spacing, Face::mirror, Face::mirror);
  model.species = false;
  Engine engine(std::move(particles), mixture, constant_diffusivity(0), model);
  run_until(engine, c.time);
  VerificationRun run = thermal_run(engine);
  const double jump = solution.temperature_left - solution.temperature_right;
  double difference = 0;
  for (std::size_t i = 0; i < engine.particles().size(); ++i) {
    const double x = engine.particles().position[i][0];
    run.position.push_back(x);
    run.value.push_back(engine.particles().temperature[i]);
    run.exact.push_back(solution(x - c.length / 2, c.time));
    difference += std::pow(run.value.back() - run.exact.back(), 2);
  }
  run.error = std::sqrt(difference / static_cast<double>(run.value.size())) / jump;
  return run;
}

VerificationRun run_stefan(const VerificationCase& c, double spacing) {
  const double melting = 600, wall = 700, mushy = 1e-3 * (wall - melting);
  const double latent = specific_heat * (wall - melting) / c.stefan;
  Material metal =
      plain_material("metal", c.diffusivity * density * specific_heat, melting, melting + mushy);
  const double at_melting = specific_heat * (melting - 298.15);
  metal.enthalpy = {{0, 298.15, melting, melting + mushy, 1000},
                    {-298.15 * specific_heat, 0, at_melting, at_melting + latent,
                     at_melting + latent + specific_heat * (1000 - melting - mushy)}};
  Particles particles = make_row(particles_along(c, c.length, spacing), spacing);
  for (double& enthalpy : particles.enthalpy) {
    enthalpy = at_melting;
  }
  Model model;
  model.domain = row_domain(c.length, spacing, Face::temperature, Face::mirror);
  model.domain.temperature[0][0] = wall;
  model.species = false;
  Engine engine(std::move(particles), Mixture(metal, metal), constant_diffusivity(0), model);
  const double lambda = stefan_lambda(c.stefan), front = c.front * c.length;
  const double time = std::pow(front / (2 * lambda), 2) / c.diffusivity;
  run_until(engine, time);
  VerificationRun run = thermal_run(engine);
  double molten = 0;
  for (std::size_t i = 0; i < engine.particles().size(); ++i) {
    const double x = engine.particles().position[i][0];
    molten += engine.particles().liquid_fraction[i] * spacing;
    run.position.push_back(x);
    run.value.push_back(engine.particles().temperature[i]);
    run.exact.push_back(stefan_temperature(x, time, c.diffusivity, lambda, wall, melting));
  }
  run.error = std::abs(molten / front - 1);
  return run;
}

}  // namespace meltproof::solver

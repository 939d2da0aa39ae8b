// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/verification/thermal_phase.hpp"

#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"
#include "solver/verification/exact.hpp"
#include "solver/verification/setup.hpp"

namespace meltproof::solver {
namespace {

constexpr double melting = 600, step = 100;  // K; |T_wall - T_melt|
constexpr double heat = PlainMatter::specific_heat;

/// A metal with latent heat in a mushy range of a thousandth of the temperature step, its middle at
/// the melting temperature.
Material two_phase_metal(double solid_conductivity, double liquid_conductivity, double latent) {
  const double solidus = melting - 5e-4 * step, liquidus = melting + 5e-4 * step;
  Material m = plain_material("metal", solid_conductivity, solidus, liquidus);
  const double at_solidus = heat * (solidus - 298.15);
  const double at_liquidus = at_solidus + latent + heat * (liquidus - solidus);
  m.enthalpy = {
      {0, 298.15, solidus, liquidus, 1000},
      {-298.15 * heat, 0, at_solidus, at_liquidus, at_liquidus + heat * (1000 - liquidus)}};
  const double slope = (liquid_conductivity - solid_conductivity) / (liquidus - solidus);
  m.conductivity.pieces = {{.from = 0, .to = solidus, .constant = solid_conductivity},
                           {.from = solidus,
                            .to = liquidus,
                            .constant = solid_conductivity - slope * solidus,
                            .linear = slope},
                           {.from = liquidus, .to = 1e6, .constant = liquid_conductivity}};
  return m;
}

}  // namespace

VerificationRun run_stefan_two_phase(const VerificationCase& c, double spacing) {
  if (c.variant != "melting" && c.variant != "solidification") {
    throw InputError(fmt::format("{}: variant \"{}\": expected \"melting\" or \"solidification\"",
                                 c.name, c.variant));
  }
  const bool melts = c.variant == "melting";
  const double near = c.diffusivity * PlainMatter::density * heat,
               far = near * c.conductivity_ratio;
  const double wall = melting + (melts ? step : -step);
  const double start = melting - (melts ? step : -step) * c.superheat;
  const Material metal =
      two_phase_metal(melts ? far : near, melts ? near : far, heat * step / c.stefan);
  const Mixture mixture(metal, metal);
  Particles particles = make_row(particles_along(c, c.length, spacing), spacing);
  for (double& enthalpy : particles.enthalpy) {
    enthalpy = mixture.enthalpy(start, 0);
  }
  Model model;
  model.domain = row_domain(c.length, spacing, Face::temperature, Face::mirror);
  model.domain.temperature[0][0] = wall;
  model.species = false;
  Engine engine(std::move(particles), mixture, constant_diffusivity(0), model);

  NeumannSolution solution{
      wall, melting, start, c.diffusivity, c.diffusivity * c.conductivity_ratio, 0};
  solution.lambda = neumann_lambda(c.stefan, c.superheat, c.conductivity_ratio);
  const double front = c.front * c.length;
  const double time = std::pow(front / (2 * solution.lambda), 2) / c.diffusivity;
  run_until(engine, time);

  VerificationRun run = thermal_run(engine);
  double changed = 0, difference = 0;
  for (std::size_t i = 0; i < engine.particles().size(); ++i) {
    const double liquid = engine.particles().liquid_fraction[i];
    changed += (melts ? liquid : 1 - liquid) * spacing;
    run.position.push_back(engine.particles().position[i][0]);
    run.value.push_back(engine.particles().temperature[i]);
    run.exact.push_back(solution(run.position.back(), time));
    difference += std::pow(run.value.back() - run.exact.back(), 2);
  }
  run.error = std::abs(changed / front - 1);
  run.extra = {{"temperature_l2_error",
                std::sqrt(difference / static_cast<double>(run.value.size())) / step},
               {"lambda", solution.lambda}};
  return run;
}

}  // namespace meltproof::solver

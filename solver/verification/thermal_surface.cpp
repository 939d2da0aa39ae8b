// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/verification/thermal_surface.hpp"

#include <cmath>

#include "solver/verification/exact.hpp"
#include "solver/verification/setup.hpp"

namespace meltproof::solver {

VerificationRun run_evaporative_cooling(const VerificationCase& c, double spacing) {
  // The vapour is that of 316L (Table A1); the rest is plain matter.
  Material melt = plain_material(
      "melt", c.diffusivity * PlainMatter::density * PlainMatter::specific_heat, 1, 2);
  melt.molar_mass = 57.96e-3;
  melt.latent_heat_vaporisation = 6.09e6;
  melt.boiling = 3073;
  melt.sticking = 0.82;
  const Mixture mixture(melt, melt);
  Particles particles = make_row(particles_along(c, c.length, spacing), spacing, 2);
  for (double& enthalpy : particles.enthalpy) {
    enthalpy = mixture.enthalpy(c.temperature, 0);
  }
  Model model;
  model.domain = row_domain(c.length, spacing, Face::mirror, Face::open, 2);
  model.species = false;
  model.surface_loss = SurfaceLossSettings{.evaporation = true, .radiation = false};
  Engine engine(std::move(particles), mixture, constant_diffusivity(0), model);
  const double start = engine.total_enthalpy();

  const auto flux = [&](double temperature) {
    // Written out once more, so that a wrong factor in the term cannot hide in both.
    const double pressure =
        101325 * std::exp(6.09e6 * 57.96e-3 / 8.31446261815324 * (1 / 3073. - 1 / temperature));
    return 0.82 * pressure * std::sqrt(57.96e-3 / (2 * M_PI * 8.31446261815324 * temperature)) *
           6.09e6;
  };
  const double capacity = PlainMatter::density * PlainMatter::specific_heat * c.length;
  double exact = c.temperature, mean = 0;
  VerificationRun samples;
  for (int i = 0; i <= 20; ++i) {
    const double now = c.time * i / 20;
    if (i > 0) {
      run_until(engine, now);
      exact = cooling_film(flux, capacity, c.temperature, now);
    }
    mean = 0;
    for (const double temperature : engine.particles().temperature) {
      mean += temperature / static_cast<double>(engine.particles().size());
    }
    samples.position.push_back(now);
    samples.value.push_back(mean);
    samples.exact.push_back(exact);
  }
  VerificationRun run = thermal_run(engine);
  run.position = samples.position;
  run.value = samples.value;
  run.exact = samples.exact;
  run.position_name = "time";
  run.position_unit = "us";
  run.error = std::abs(mean - exact) / (c.temperature - exact);
  const double lost = start - engine.total_enthalpy(), evaporated = engine.ledger().evaporated;
  const double slope = (flux(c.temperature + 1) - flux(c.temperature - 1)) / 2;
  run.extra = {{"energy_balance_error", std::abs(lost - evaporated) / evaporated},
               {"biot_number", slope * c.length / melt.conductivity(c.temperature)},
               {"temperature_K", mean}};
  if (!(std::abs(lost - evaporated) <= 1e-9 * evaporated)) {
    run.broken.emplace_back("the energy that left differs from the ledger's by more than 1e-9");
  }
  return run;
}

}  // namespace meltproof::solver

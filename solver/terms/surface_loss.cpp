// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/terms/surface_loss.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace meltproof::solver {
namespace {

constexpr double gas_constant = 8.31446261815324;    // J mol-1 K-1, CODATA 2018
constexpr double stefan_boltzmann = 5.670374419e-8;  // W m-2 K-4, CODATA 2018

}  // namespace

double evaporation_flux(double temperature, double concentration, const Mixture& mixture,
                        double ambient_pressure) {
  const double molar_mass = mixture.molar_mass(concentration);
  const double latent_heat = mixture.latent_heat_vaporisation(concentration);
  const double pressure =
      ambient_pressure * std::exp(latent_heat * molar_mass / gas_constant *
                                  (1 / mixture.boiling(concentration) - 1 / temperature));
  const double mass_flux =
      mixture.sticking(concentration) * pressure *
      std::sqrt(molar_mass / (2 * std::numbers::pi * gas_constant * temperature));
  return mass_flux * latent_heat;
}

double radiation_flux(double temperature, double emissivity, double ambient_temperature) {
  return emissivity * stefan_boltzmann *
         (std::pow(temperature, 4) - std::pow(ambient_temperature, 4));
}

SurfaceLossBudget lose_heat(const Particles& particles, const SurfaceColumns& columns,
                            const Mixture& mixture, const SurfaceLossSettings& settings,
                            std::vector<double>& power) {
  SurfaceLossBudget budget;
  const double area = columns.width * columns.width;
  for (const std::uint32_t i : columns.top) {
    if (i == SurfaceColumns::none) {
      continue;
    }
    const double temperature = particles.temperature[i], concentration = particles.concentration[i];
    // Below 1000 K the vapour pressure of either alloy is nil and the exponential not worth its
    // time.
    const double evaporated = settings.evaporation && temperature > 1000
                                  ? area * evaporation_flux(temperature, concentration, mixture,
                                                            settings.ambient_pressure)
                                  : 0;
    const double radiated =
        settings.radiation ? area * radiation_flux(temperature, mixture.emissivity(concentration),
                                                   settings.ambient_temperature)
                           : 0;
    if (evaporated + radiated > 0) {
      // d(loss)/dT: the vapour pressure's exponential rules evaporation, T^4 rules radiation. A
      // particle has four columns.
      const double boltzmann_temperature = mixture.latent_heat_vaporisation(concentration) *
                                           mixture.molar_mass(concentration) / gas_constant;
      const double slope = 4 * (evaporated * boltzmann_temperature / (temperature * temperature) +
                                4 * radiated / temperature);
      budget.fastest_rate = std::max(
          budget.fastest_rate, slope / (particles.mass[i] * mixture.smallest_specific_heat_near(
                                                                temperature, concentration)));
    }
    power[i] -= evaporated + radiated;
    budget.evaporation += evaporated;
    budget.radiation += radiated;
  }
  return budget;
}

}  // namespace meltproof::solver

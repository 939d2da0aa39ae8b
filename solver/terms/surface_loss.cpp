// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/terms/surface_loss.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace meltproof::solver {
namespace {

constexpr double gas_constant = 8.31446261815324;    // J mol-1 K-1, CODATA 2018
constexpr double stefan_boltzmann = 5.670374419e-8;  // W m-2 K-4, CODATA 2018
constexpr double recoil_share = 0.54;                // of the saturation pressure, Knight (1979)

/// What a square metre gives off, and how fast that rises with its temperature.
struct LossPerArea {
  double mass = 0, evaporation = 0, radiation = 0, convection = 0;  ///< kg s-1 m-2, W m-2
  double slope = 0;                                                 ///< W m-2 K-1

  double total() const { return evaporation + radiation + convection; }
};

LossPerArea loss_per_area(double temperature, double concentration, const Mixture& mixture,
                          const SurfaceLossSettings& settings) {
  LossPerArea loss;
  // Below 1000 K the vapour pressure of every alloy here is nil and the exponential not worth its
  // time.
  if (settings.evaporation && temperature > 1000) {
    loss.mass =
        evaporation_mass_flux(temperature, concentration, mixture, settings.ambient_pressure);
    loss.evaporation = evaporation_flux(temperature, concentration, mixture,
                                        settings.ambient_pressure, settings.vapour_heat);
  }
  if (settings.radiation) {
    loss.radiation = radiation_flux(temperature, mixture.emissivity(concentration),
                                    settings.ambient_temperature);
  }
  loss.convection =
      settings.heat_transfer_coefficient * (temperature - settings.ambient_temperature);
  // The vapour pressure's exponential rules evaporation, T^4 rules radiation.
  const double boltzmann_temperature = mixture.latent_heat_vaporisation(concentration) *
                                       mixture.molar_mass(concentration) / gas_constant;
  loss.slope = loss.evaporation * boltzmann_temperature / (temperature * temperature) +
               4 * loss.radiation / temperature + settings.heat_transfer_coefficient;
  return loss;
}

/// Sums that are the same for any order of the particles, and so for any division among ranks.
struct LossSums {
  ExactSum evaporation, radiation, convection, mass_rate;

  void add(const LossPerArea& loss, double area) {
    evaporation.add(area * loss.evaporation);
    radiation.add(area * loss.radiation);
    convection.add(area * loss.convection);
    mass_rate.add(area * loss.mass);
  }
  void write(SurfaceLossBudget& budget, const Ranks& ranks) {
    for (ExactSum* sum : {&evaporation, &radiation, &convection, &mass_rate}) {
      ranks.add(*sum);
    }
    budget.evaporation = evaporation.total();
    budget.radiation = radiation.total();
    budget.convection = convection.total();
    budget.mass_rate = mass_rate.total();
  }
};

void limit_rate(const Particles& particles, std::uint32_t i, const Mixture& mixture, double slope,
                SurfaceLossBudget& budget) {
  if (slope > 0) {
    budget.fastest_rate = std::max(
        budget.fastest_rate,
        slope / (particles.mass[i] * mixture.smallest_specific_heat_near(
                                         particles.temperature[i], particles.concentration[i])));
  }
}

}  // namespace

double saturation_pressure(double temperature, double concentration, const Mixture& mixture,
                           double ambient_pressure) {
  const double boltzmann_temperature = mixture.latent_heat_vaporisation(concentration) *
                                       mixture.molar_mass(concentration) / gas_constant;
  return ambient_pressure *
         std::exp(boltzmann_temperature * (1 / mixture.boiling(concentration) - 1 / temperature));
}

double recoil_pressure(double temperature, double concentration, const Mixture& mixture,
                       double ambient_pressure) {
  return recoil_share * saturation_pressure(temperature, concentration, mixture, ambient_pressure);
}

double evaporation_mass_flux(double temperature, double concentration, const Mixture& mixture,
                             double ambient_pressure) {
  return mixture.sticking(concentration) *
         saturation_pressure(temperature, concentration, mixture, ambient_pressure) *
         std::sqrt(mixture.molar_mass(concentration) /
                   (2 * std::numbers::pi * gas_constant * temperature));
}

double evaporation_flux(double temperature, double concentration, const Mixture& mixture,
                        double ambient_pressure, VapourHeat heat) {
  const double per_mass =
      mixture.latent_heat_vaporisation(concentration) +
      (heat == VapourHeat::latent ? 0 : mixture.enthalpy(temperature, concentration));
  return evaporation_mass_flux(temperature, concentration, mixture, ambient_pressure) * per_mass;
}

double radiation_flux(double temperature, double emissivity, double ambient_temperature) {
  return emissivity * stefan_boltzmann *
         (std::pow(temperature, 4) - std::pow(ambient_temperature, 4));
}

SurfaceLossBudget lose_heat(const Particles& particles, const SurfaceColumns& columns,
                            const Mixture& mixture, const SurfaceLossSettings& settings,
                            std::vector<double>& power, const Ranks& ranks) {
  SurfaceLossBudget budget;
  LossSums sums;
  const double area = columns.width * columns.width;
  for (const std::uint32_t i : columns.top) {
    if (i == SurfaceColumns::none || i == SurfaceColumns::elsewhere) {
      continue;
    }
    const LossPerArea loss =
        loss_per_area(particles.temperature[i], particles.concentration[i], mixture, settings);
    power[i] -= area * loss.total();
    sums.add(loss, area);
    // A particle has four columns.
    limit_rate(particles, i, mixture, 4 * area * loss.slope, budget);
  }
  sums.write(budget, ranks);
  return budget;
}

SurfaceLossBudget lose_heat(const Particles& particles, const std::vector<ExposedArea>& areas,
                            const Mixture& mixture, const SurfaceLossSettings& settings,
                            std::vector<double>& power, const Ranks& ranks) {
  SurfaceLossBudget budget;
  LossSums sums;
  for (const auto& [i, area] : areas) {
    const LossPerArea loss =
        loss_per_area(particles.temperature[i], particles.concentration[i], mixture, settings);
    power[i] -= area * loss.total();
    sums.add(loss, area);
    limit_rate(particles, i, mixture, area * loss.slope, budget);
  }
  sums.write(budget, ranks);
  return budget;
}

}  // namespace meltproof::solver

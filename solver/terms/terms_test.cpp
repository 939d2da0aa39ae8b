// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "solver/terms/conduction.hpp"
#include "solver/terms/laser.hpp"
#include "solver/terms/species.hpp"
#include "solver/terms/surface_loss.hpp"

namespace meltproof::solver {
namespace {

Mixture paper_mixture() {
  return {read_material("data/materials/316L.toml"), read_material("data/materials/AlSi10Mg.toml")};
}

/// A plate of nx x ny particles, two layers deep, with its surface at z = 0.
Particles plate(std::size_t nx, std::size_t ny, double dx) {
  Particles particles;
  particles.spacing = dx;
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t j = 0; j < ny; ++j) {
      for (std::size_t i = 0; i < nx; ++i) {
        particles.add(static_cast<std::int64_t>(particles.size()),
                      {(static_cast<double>(i) + 0.5) * dx, (static_cast<double>(j) + 0.5) * dx,
                       (static_cast<double>(k) - 1.5) * dx},
                      1e-12, dx * dx * dx, 0, 0, Origin::plate);
      }
    }
  }
  return particles;
}

/// Of each particle, from a list.
auto of(const std::vector<double>& values) {
  return [&](std::uint32_t i) { return values[i]; };
}

}  // namespace

TEST(Conduction, APairLosesNothing) {
  const double k_i = 15, k_j = 155, t_i = 900, t_j = 400, v_i = 2.0, v_j = 3.0, f = -0.7;
  EXPECT_DOUBLE_EQ(v_i * conduction_pair(k_i, t_i, k_j, t_j, v_j, f),
                   -v_j * conduction_pair(k_j, t_j, k_i, t_i, v_i, f));
  EXPECT_LT(conduction_pair(k_i, t_i, k_j, t_j, v_j, f), 0) << "the hotter one cools";
}

TEST(Conduction, TheMeanConductivityIsHarmonic) {
  // 4 k k'/(k + k'), so 2 k for equal ones and four times the smaller one against a perfect
  // conductor.
  EXPECT_DOUBLE_EQ(conduction_pair(10.0, 1.0, 10.0, 0.0, 1.0, -1.0), -20);
  EXPECT_NEAR(conduction_pair(10.0, 1.0, 1e12, 0.0, 1.0, -1.0), -40, 1e-6);
}

TEST(Species, APairLosesNothingAndSolidsTakeNoPart) {
  const double v_i = 2, v_j = 3, f = -0.7;
  const double ij = species_pair(1e-9, 7763.0, 0.9, 4e-9, 7763.0, 0.1, v_j, f, 2.0);
  const double ji = species_pair(4e-9, 7763.0, 0.1, 1e-9, 7763.0, 0.9, v_i, f, 2.0);
  EXPECT_DOUBLE_EQ(v_i * ij, -v_j * ji);
  EXPECT_NE(ij, 0);
  EXPECT_EQ(species_pair(1e-9, 7763.0, 0.9, 0.0, 7763.0, 0.1, v_j, f, 2.0), 0);
  EXPECT_EQ(species_pair(0.0, 7763.0, 0.9, 0.0, 7763.0, 0.1, v_j, f, 2.0), 0);
}

TEST(Species, AsPrintedIsTwiceTheConsistentForm) {
  EXPECT_DOUBLE_EQ(species_pair(1e-9, 7763.0, 0.9, 4e-9, 7763.0, 0.1, 1.0, -1.0, 4.0),
                   2 * species_pair(1e-9, 7763.0, 0.9, 4e-9, 7763.0, 0.1, 1.0, -1.0, 2.0));
}

TEST(Laser, AbsorbedReflectedAndMissedAreThePower) {
  const double dx = 10e-6;
  const Particles particles = plate(40, 20, dx);
  const auto columns = find_surface(particles, {0, 0, 0}, {40 * dx, 20 * dx, 0});
  std::vector<double> absorptivity(particles.size()), power(particles.size(), 0.0);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    absorptivity[i] = i % 3 == 0 ? 0.09 : 0.4;
  }
  // In the middle, half over the edge, and off the plate.
  for (const double x : {200e-6, 0.0, -90e-6, -400e-6}) {
    std::fill(power.begin(), power.end(), 0.0);
    const Laser laser{
        .power = 175, .radius = 40e-6, .speed = 0.375, .start_x = x, .y = 100e-6, .exposure = 1};
    const LaserBudget budget = irradiate(laser, 0, columns, of(absorptivity), power);
    EXPECT_NEAR(budget.absorbed + budget.reflected + budget.missed, 175, 175e-12) << x;
    double taken = 0;
    for (const double p : power) {
      taken += p;
    }
    EXPECT_NEAR(taken, budget.absorbed, 175e-12);
  }
}

TEST(Laser, AUniformPlateAbsorbsATimesPToRoundOff) {
  const double dx = 10e-6;
  const Particles particles = plate(40, 40, dx);
  const auto columns = find_surface(particles, {0, 0, 0}, {40 * dx, 40 * dx, 0});
  std::vector<double> power(particles.size(), 0.0);
  const Laser laser{.power = 175,
                    .radius = 40e-6,
                    .speed = 0.375,
                    .start_x = 203.1e-6,
                    .y = 197e-6,
                    .exposure = 1};
  const LaserBudget budget = irradiate(
      laser, 0, columns, [](std::uint32_t) { return 0.4; }, power);
  EXPECT_NEAR(budget.absorbed, 70, 70e-13);
  EXPECT_EQ(budget.missed, 0);
}

TEST(Laser, TheDepositIsTheGaussianOfItsRadius) {
  const double dx = 2e-6, radius = 40e-6;
  const Particles particles = plate(200, 200, dx);
  const auto columns = find_surface(particles, {0, 0, 0}, {200 * dx, 200 * dx, 0});
  std::vector<double> power(particles.size(), 0.0);
  const Laser laser{
      .power = 100, .radius = radius, .speed = 1, .start_x = 200e-6, .y = 200e-6, .exposure = 1};
  irradiate(
      laser, 0, columns, [](std::uint32_t) { return 1.0; }, power);
  // Inside the 1/e2 radius lies 1 - exp(-2) of the power; its second moment along x is r^2/4.
  double inside = 0, moment = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const double x = particles.position[i][0] - 200e-6, y = particles.position[i][1] - 200e-6;
    inside += x * x + y * y < radius * radius ? power[i] : 0;
    moment += power[i] * x * x / 100;
  }
  EXPECT_NEAR(inside / 100, 1 - std::exp(-2.0), 2e-3);
  EXPECT_NEAR(moment / (radius * radius / 4), 1, 2e-3);
}

TEST(Laser, WhatLiesInTheShadowGetsNothing) {
  const double dx = 10e-6;
  Particles particles = plate(10, 10, dx);
  const auto below = [&] {
    for (std::size_t i = 0; i < particles.size(); ++i) {
      if (std::abs(particles.position[i][0] - 55e-6) < 1e-9 &&
          std::abs(particles.position[i][1] - 55e-6) < 1e-9 && particles.position[i][2] > -10e-6) {
        return i;
      }
    }
    return particles.size();
  }();
  ASSERT_LT(below, particles.size());
  particles.add(10000, {55e-6, 55e-6, 30e-6}, 1e-12, dx * dx * dx, 0, 0, Origin::base_powder);
  const auto columns = find_surface(particles, {0, 0, 0}, {10 * dx, 10 * dx, 0});
  std::vector<double> power(particles.size(), 0.0);
  const Laser laser{
      .power = 100, .radius = 30e-6, .speed = 1, .start_x = 50e-6, .y = 50e-6, .exposure = 1};
  irradiate(
      laser, 0, columns, [](std::uint32_t) { return 1.0; }, power);
  EXPECT_EQ(power[below], 0);
  EXPECT_GT(power.back(), 0);
  EXPECT_GT(power[below - 1], 0);
}

TEST(Laser, AnInclinedBeamLosesNothing) {
  const double dx = 10e-6;
  Particles particles = plate(40, 20, dx);
  for (std::int64_t i = 0; i < 60; ++i) {  // some loose grains above the plate
    particles.add(
        1000 + i,
        {static_cast<double>((37 * i) % 400) * 1e-6, static_cast<double>((91 * i) % 200) * 1e-6,
         static_cast<double>((7 * i) % 50) * 1e-6},
        1e-12, dx * dx * dx, 0, 0, Origin::base_powder);
  }
  std::vector<double> absorptivity(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    absorptivity[i] = i % 3 == 0 ? 0.09 : 0.4;
  }
  for (const double incidence : {0.05, 0.3, M_PI / 4}) {
    for (const double azimuth : {0.0, 0.65, M_PI / 2, 4.0}) {
      const Laser laser{.power = 175,
                        .radius = 40e-6,
                        .speed = 0.375,
                        .start_x = 160e-6,
                        .y = 100e-6,
                        .exposure = 1,
                        .incidence = incidence,
                        .azimuth = azimuth};
      const auto columns = find_surface(particles, {0, 0, 0}, {40 * dx, 20 * dx, 0}, laser.slant());
      std::vector<double> power(particles.size(), 0.0);
      const LaserBudget budget = irradiate(laser, 0, columns, of(absorptivity), power);
      EXPECT_NEAR(budget.absorbed + budget.reflected + budget.missed, 175, 175e-12);
      EXPECT_NEAR(std::accumulate(power.begin(), power.end(), 0.0), budget.absorbed, 175e-12);
      EXPECT_GT(budget.absorbed, 0.05 * 175);
    }
  }
}

TEST(Laser, TheFootprintOfAnInclinedBeamIsAnEllipse) {
  const double dx = 2e-6, radius = 30e-6, incidence = 0.6, azimuth = 0.5;
  const Particles particles = plate(200, 200, dx);
  const Laser laser{.power = 100,
                    .radius = radius,
                    .speed = 1,
                    .start_x = 200e-6,
                    .y = 200e-6,
                    .exposure = 1,
                    .incidence = incidence,
                    .azimuth = azimuth};
  const auto columns = find_surface(particles, {0, 0, 0}, {200 * dx, 200 * dx, 0}, laser.slant());
  std::vector<double> power(particles.size(), 0.0);
  const LaserBudget budget = irradiate(
      laser, 0, columns, [](std::uint32_t) { return 1.0; }, power);
  EXPECT_NEAR(budget.absorbed, 100, 1e-10);
  // Centres of the top layer lie half a spacing below z = 0, where the axis has moved on a little.
  const double shift = dx / 2 * std::tan(incidence);
  double along = 0, across = 0, mean = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const double x = particles.position[i][0] - 200e-6, y = particles.position[i][1] - 200e-6;
    const double u = x * std::cos(azimuth) + y * std::sin(azimuth) - shift;
    const double w = y * std::cos(azimuth) - x * std::sin(azimuth);
    mean += power[i] * u / 100;
    along += power[i] * u * u / 100;
    across += power[i] * w * w / 100;
    EXPECT_TRUE(power[i] == 0 || particles.position[i][2] > -dx) << "the layer below sees nothing";
  }
  EXPECT_NEAR(mean, 0, 0.3 * dx);
  EXPECT_NEAR(across / (radius * radius / 4), 1, 5e-3);
  EXPECT_NEAR(along / (std::pow(radius / std::cos(incidence), 2) / 4), 1, 5e-3);
}

TEST(Laser, AnAlmostVerticalBeamIsTheVerticalOne) {
  const double dx = 5e-6;
  const Particles particles = plate(60, 60, dx);
  const auto columns = find_surface(particles, {0, 0, 0}, {60 * dx, 60 * dx, 0});
  Laser laser{
      .power = 100, .radius = 40e-6, .speed = 1, .start_x = 151e-6, .y = 149e-6, .exposure = 1};
  const std::vector<double> absorptivity(particles.size(), 0.4);
  std::vector<double> vertical(particles.size(), 0.0), inclined(particles.size(), 0.0);
  irradiate(laser, 0, columns, of(absorptivity), vertical);
  laser.incidence = 1e-9;
  irradiate(laser, 0, columns, of(absorptivity), inclined);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    EXPECT_NEAR(vertical[i], inclined[i], 1e-5);
  }
}

TEST(Laser, TheShadowOfAGrainLiesAlongTheBeam) {
  const double dx = 10e-6;
  Particles particles = plate(20, 10, dx);
  // 50 um above the plate's top layer, at 45 degrees along x: the shadow falls 50 um further on.
  particles.add(10000, {55e-6, 45e-6, 45e-6}, 1e-12, dx * dx * dx, 0, 0, Origin::base_powder);
  const Laser laser{.power = 100,
                    .radius = 60e-6,
                    .speed = 1,
                    .start_x = 100e-6,
                    .y = 45e-6,
                    .exposure = 1,
                    .incidence = M_PI / 4,
                    .azimuth = 0};
  const auto columns = find_surface(particles, {0, 0, 0}, {20 * dx, 10 * dx, 0}, laser.slant());
  std::vector<double> power(particles.size(), 0.0);
  irradiate(
      laser, 0, columns, [](std::uint32_t) { return 1.0; }, power);
  for (std::size_t i = 0; i + 1 < particles.size(); ++i) {
    const auto& at = particles.position[i];
    if (at[2] > -dx && std::abs(at[1] - 45e-6) < 1e-9 && at[0] > 20e-6 && at[0] < 180e-6) {
      EXPECT_EQ(power[i] == 0, std::abs(at[0] - 105e-6) < 1e-9) << at[0];
    }
  }
  EXPECT_GT(power.back(), 0);
}

TEST(SurfaceLoss, EvaporationAtTheBoilingPointIsTheHertzKnudsenFlux) {
  const Mixture mixture = paper_mixture();
  const Material& steel = mixture.base();
  // At the boiling point the vapour pressure is the ambient one: m' = 0.82 p_a sqrt(M/(2 pi R
  // T_b)).
  const double mass_flux = 0.82 * 101325 * std::sqrt(57.96e-3 / (2 * M_PI * 8.314462618 * 3073));
  EXPECT_NEAR(evaporation_flux(3073, 0, mixture, 101325),
              mass_flux * steel.latent_heat_vaporisation,
              1e-6 * mass_flux * steel.latent_heat_vaporisation);
}

TEST(SurfaceLoss, RecoilIsItsShareOfTheFullSaturationPressure) {
  const Mixture mixture = paper_mixture();
  EXPECT_NEAR(saturation_pressure(3073, 0, mixture, 101325), 101325, 1e-6);
  EXPECT_NEAR(recoil_pressure(3073, 0, mixture, 101325), 0.54 * 101325, 1e-6);
  // Clausius-Clapeyron: d ln p/d(1/T) = -L_v M/R.
  const double slope = std::log(saturation_pressure(3600, 0, mixture, 101325) /
                                saturation_pressure(2800, 0, mixture, 101325)) /
                       (1.0 / 2800 - 1.0 / 3600);
  EXPECT_NEAR(slope, mixture.latent_heat_vaporisation(0) * 57.96e-3 / 8.314462618, 1e-6 * slope);
}

TEST(SurfaceLoss, TheVapourTakesItsSensibleHeatOnlyWhenAsked) {
  const Mixture mixture = paper_mixture();
  const double flux = evaporation_mass_flux(3300, 0.1, mixture, 101325);
  EXPECT_DOUBLE_EQ(evaporation_flux(3300, 0.1, mixture, 101325),
                   flux * mixture.latent_heat_vaporisation(0.1));
  EXPECT_NEAR(evaporation_flux(3300, 0.1, mixture, 101325, VapourHeat::latent_and_sensible),
              flux * (mixture.latent_heat_vaporisation(0.1) + mixture.enthalpy(3300, 0.1)),
              1e-9 * flux * mixture.latent_heat_vaporisation(0.1));
}

TEST(SurfaceLoss, AFlatSurfaceLosesTheSameByColumnsAndByArea) {
  const Mixture mixture = paper_mixture();
  const double dx = 10e-6;
  Particles particles = plate(6, 4, dx);
  std::vector<ExposedArea> area;
  for (std::uint32_t i = 0; i < particles.size(); ++i) {
    particles.temperature[i] = 2900 + 50 * static_cast<double>(i % 7);
    particles.concentration[i] = 0.02 * static_cast<double>(i % 3);
    if (particles.position[i][2] > -dx) {
      area.push_back({i, dx * dx});
    }
  }
  const SurfaceLossSettings settings{.heat_transfer_coefficient = 80};
  const auto columns = find_surface(particles, {0, 0, 0}, {6 * dx, 4 * dx, 0});
  std::vector<double> by_columns(particles.size(), 0.0), by_area(particles.size(), 0.0);
  const SurfaceLossBudget one = lose_heat(particles, columns, mixture, settings, by_columns);
  const SurfaceLossBudget two = lose_heat(particles, area, mixture, settings, by_area);
  double lost = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    EXPECT_NEAR(by_columns[i], by_area[i], 1e-12 * std::abs(by_area[i]));
    lost -= by_area[i];
  }
  EXPECT_NEAR(two.evaporation + two.radiation + two.convection, lost, 1e-12 * lost);
  EXPECT_NEAR(one.convection, two.convection, 1e-12 * two.convection);
  EXPECT_NEAR(one.mass_rate, two.mass_rate, 1e-12 * two.mass_rate);
  EXPECT_NEAR(one.fastest_rate, two.fastest_rate, 1e-12 * two.fastest_rate);
  EXPECT_GT(two.convection, 0);
}

// Paper errata 14: with the printed molar mass of AlSi10Mg, 332.14 g/mol, the exponent is twelve
// times larger, and far from the boiling point the vapour pressure is off by orders of magnitude.
TEST(SurfaceLoss, ThePrintedMolarMassOfTheAdditiveBlowsUp) {
  const Material steel = read_material("data/materials/316L.toml");
  const Mixture repaired(steel, read_material("data/materials/AlSi10Mg.toml"));
  const Mixture printed(steel, read_material("data/materials/AlSi10Mg.toml", Form::as_printed));
  const double ratio =
      evaporation_flux(3300, 1, printed, 101325) / evaporation_flux(3300, 1, repaired, 101325);
  EXPECT_GT(ratio, 1e3);
}

TEST(SurfaceLoss, RadiationIsStefanBoltzmanns) {
  EXPECT_NEAR(radiation_flux(1000, 1, 0), 56703.74419, 1e-4);
  EXPECT_EQ(radiation_flux(300, 0.4, 300), 0);
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/step/engine.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>
#include <omp.h>

#include "solver/verification/case.hpp"
#include "solver/verification/exact.hpp"

namespace meltproof::solver {
namespace {

Mixture paper_mixture() {
  return {read_material("data/materials/316L.toml"), read_material("data/materials/AlSi10Mg.toml")};
}

Diffusivity liquid_metal() {
  return read_diffusivity("data/materials/diffusivity.toml", "liquid_metal");
}

/// A small plate with two additive grains on it, under a beam hot enough to melt and evaporate.
Engine small_track() {
  const Mixture mixture = paper_mixture();
  const double dx = 10e-6, volume = dx * dx * dx;
  Particles particles;
  particles.spacing = dx;
  for (int k = 0; k < 9; ++k) {
    for (int j = 0; j < 16; ++j) {
      for (int i = 0; i < 20; ++i) {
        const bool grain = k == 8 && ((i > 7 && i < 10 && j > 6 && j < 9) ||
                                      (i > 11 && i < 14 && j > 8 && j < 11));
        if (k == 8 && !grain) {
          continue;
        }
        particles.add(static_cast<std::int64_t>(particles.size()),
                      {(i + 0.5) * dx, (j + 0.5) * dx, (k - 7.5) * dx}, mixture.density(0) * volume,
                      volume, mixture.enthalpy(300, grain ? 1 : 0), grain ? 1 : 0,
                      grain ? Origin::additive_powder : Origin::plate);
      }
    }
  }
  Model model;
  model.domain.lower = {0, 0, -80e-6};
  model.domain.upper = {200e-6, 160e-6, 10e-6};
  model.laser = Laser{
      .power = 175, .radius = 40e-6, .speed = 0.375, .start_x = 70e-6, .y = 80e-6, .exposure = 1};
  model.surface_loss = SurfaceLossSettings{};
  return {std::move(particles), mixture, liquid_metal(), model};
}

}  // namespace

TEST(TimeStep, CriteriaAreThoseOfMorrisAndEquation5) {
  const auto limits = step_limits({.smoothing_length = 2e-6,
                                   .sound_speed = 48,
                                   .speed = 2,
                                   .kinematic_viscosity = 1e-5,
                                   .surface_tension = 1.8,
                                   .density = 7763,
                                   .thermal_diffusivity = 5.5e-6,
                                   .species_diffusivity = 1e-8,
                                   .gravity = 9.81,
                                   .surface_rate = 1e6});
  EXPECT_NEAR(limits.acoustic, 1e-8, 1e-20);
  EXPECT_NEAR(limits.viscous, 5e-8, 1e-20);
  EXPECT_NEAR(limits.capillary, 0.25 * std::sqrt(7763 * 8e-18 / (2 * M_PI * 1.8)), 1e-20);
  EXPECT_NEAR(limits.thermal, 0.125 * 4e-12 / 5.5e-6, 1e-20);
  EXPECT_NEAR(limits.species, 0.125 * 4e-12 / 1e-8, 1e-18);
  EXPECT_NEAR(limits.gravity, 0.25 * std::sqrt(2e-6 / 9.81), 1e-18);
  EXPECT_NEAR(limits.surface, 5e-7, 1e-20);
  EXPECT_EQ(limits.smallest_name(), "acoustic");
  EXPECT_NEAR(step_limits({.smoothing_length = 2e-6, .sound_speed = 48, .courant = 0.4, .speed = 2})
                  .acoustic,
              1.6e-8, 1e-20);
  EXPECT_EQ(step_limits({.smoothing_length = 1, .sound_speed = 0}).smallest(),
            std::numeric_limits<double>::infinity());
}

TEST(Engine, EnergyAndAdditiveAreKept) {
  Engine engine = small_track();
  const double enthalpy = engine.total_enthalpy(), additive = engine.total_additive_mass();
  while (engine.time() < 1e-4) {
    engine.step(1e-4);
  }
  const EnergyLedger& ledger = engine.ledger();
  const double change = engine.total_enthalpy() - enthalpy;
  EXPECT_GT(ledger.evaporated, 0.01 * ledger.absorbed) << "the test is to melt and evaporate";
  EXPECT_NEAR(ledger.absorbed - ledger.evaporated - ledger.radiated, change,
              1e-12 * ledger.absorbed);
  EXPECT_NEAR(ledger.absorbed + ledger.reflected + ledger.missed, 175 * 1e-4, 175e-16);
  EXPECT_NEAR(engine.total_additive_mass() / additive, 1, 1e-13);
  double smallest = 1, mixed = 0;
  for (std::size_t i = 0; i < engine.particles().size(); ++i) {
    const double c = engine.particles().concentration[i];
    smallest = std::min(smallest, c);
    mixed = std::max(mixed, engine.particles().origin[i] == Origin::plate ? c : 0.0);
  }
  EXPECT_GT(mixed, 1e-4) << "the additive must have entered the plate";
  EXPECT_GT(smallest, -3e-3)
      << "the overshoot of the fourth-moment operator stays below 0.3 % of the jump";
}

TEST(Engine, AnyNumberOfThreadsGivesTheSameBytes) {
  const auto run = [](int threads) {
    omp_set_num_threads(threads);
    Engine engine = small_track();
    while (engine.time() < 3e-5) {
      engine.step(3e-5);
    }
    return engine;
  };
  const Engine one = run(1);
  for (const int threads : {2, 3}) {
    const Engine many = run(threads);
    EXPECT_EQ(one.steps(), many.steps());
    EXPECT_EQ(one.particles().enthalpy, many.particles().enthalpy);
    EXPECT_EQ(one.particles().concentration, many.particles().concentration);
    EXPECT_EQ(one.total_enthalpy(), many.total_enthalpy());
  }
}

// A solid exactly at its melting point has the huge apparent specific heat of melting: a step
// chosen by it overheats the first particle of the wall without bound.
TEST(Engine, MeltingFromRestNeverOvershootsTheWall) {
  VerificationCase c;
  c.kind = "stefan";
  c.length = 100e-6;
  c.diffusivity = 5.5e-6;
  for (const double stefan : {0.1, 0.5, 1.0}) {
    c.stefan = stefan;
    const auto run = run_case(c, 4e-6);
    for (const double temperature : run.value) {
      ASSERT_LT(temperature, 700) << "the wall is at 700 K, St = " << stefan;
      ASSERT_GE(temperature, 600 * (1 - 1e-12)) << "nothing is colder than the melting point";
    }
  }
}

TEST(Engine, ANumberThatIsNoneStopsTheRunAndNamesTheParticle) {
  Engine good = small_track();
  Particles particles = good.particles();
  particles.enthalpy[5] = std::nan("");
  try {
    const Engine bad(particles, paper_mixture(), liquid_metal(), good.model());
    FAIL();
  } catch (const std::runtime_error& problem) {
    EXPECT_NE(std::string(problem.what()).find("is not a number"), std::string::npos)
        << problem.what();
  }
}

// Paper errata 5: Eqs. 3-4 are two explicit half steps, so first order; the midpoint step is
// second.
TEST(SpeciesScheme, AsPrintedIsFirstOrderAndMidpointSecond) {
  const auto order = [](const std::string& scheme) {
    // The same lattice with ever smaller steps: what differs is the error in time alone.
    const auto error = [&](double factor) {
      const double dx = 1e-6;
      Particles row;
      row.spacing = dx;
      for (int i = 0; i < 40; ++i) {
        const double mode = std::cos(M_PI * (i + 0.5) / 40);
        row.add(i, {(i + 0.5) * dx, dx / 2, dx / 2}, 1e-15, dx * dx * dx, 1e6, 0.5 + 0.4 * mode,
                Origin::plate);
      }
      Material melt = read_material("data/materials/AlSi10Mg.toml");
      Model model;
      model.domain.upper = {40e-6, dx, dx};
      model.domain.face = {{{Face::mirror, Face::mirror},
                            {Face::periodic, Face::periodic},
                            {Face::periodic, Face::periodic}}};
      model.conduction = false;
      model.species_scheme =
          scheme == "midpoint" ? SpeciesScheme::midpoint : SpeciesScheme::as_printed;
      model.step_factor = factor;
      Diffusivity law;
      law.prefactor = 1e-9;
      Engine engine(row, Mixture(melt, melt), law, model);
      const double end = 0.08;
      while (engine.time() < end) {
        engine.step(end);
      }
      double amplitude = 0;
      for (std::size_t i = 0; i < 40; ++i) {
        amplitude += (engine.particles().concentration[i] - 0.5) *
                     std::cos(M_PI * engine.particles().position[i][0] / 40e-6) / 20;
      }
      return amplitude;
    };
    const double a = error(2), b = error(1), c = error(0.5);
    return std::log2((a - b) / (b - c));
  };
  EXPECT_NEAR(order("as_printed"), 1.0, 0.1);
  EXPECT_NEAR(order("midpoint"), 2.0, 0.15);
}

TEST(ExactSolutions, StefanLambdaIsThePublishedOne) {
  EXPECT_NEAR(stefan_lambda(0.1), 0.220016, 1e-6);
  EXPECT_NEAR(stefan_lambda(0.5), 0.464786, 1e-6);
  EXPECT_NEAR(stefan_lambda(1), 0.620063, 1e-6);
  EXPECT_NEAR(stefan_lambda(2), 0.800601, 1e-6);
}

// Paper errata 4: Eqs. 9-10 hold for a spread of 2 um, not for 20 um.
TEST(ExactSolutions, ThePrintedStripeHoldsOnlyForSmallSpreads) {
  const double z1 = 44e-6, z2 = 55e-6, middle = 49.5e-6;
  const StripeSolution stripe{z1, z2, 100e-6};
  EXPECT_NEAR(printed_stripe(middle, z1, z2, 20e-6), 0.651, 5e-4);
  EXPECT_NEAR(stripe(middle, 20e-6), 0.303, 5e-4);
  for (double z = 30e-6; z < 70e-6; z += 1.3e-6) {
    EXPECT_NEAR(printed_stripe(z, z1, z2, 2e-6), stripe(z, 2e-6), 2e-4);
  }
}

TEST(ExactSolutions, TheStripeKeepsItsMassBetweenItsWalls) {
  const StripeSolution stripe{44e-6, 55e-6, 100e-6};
  for (const double spread : {2e-6, 20e-6, 200e-6}) {
    double sum = 0;
    for (int i = 0; i < 10000; ++i) {
      sum += stripe((i + 0.5) * 1e-8, spread) * 1e-8;
    }
    EXPECT_NEAR(sum, 11e-6, 1e-12) << spread;
  }
}

TEST(Verification, TheSpeciesOperatorChosenBeatsThePlainOne) {
  VerificationCase c;
  c.kind = "species_stripe";
  const double fourth = run_case(c, 1e-6).error;
  c.species_operator = "second";
  const double second = run_case(c, 1e-6).error;
  // sqrt(4Dt) = 2 um at 1 um: 0.3 % against 1.5 %, so only the fourth moment meets the 1 % asked.
  EXPECT_LT(fourth, 0.005);
  EXPECT_GT(second, 0.01);
}

namespace {

/// A block of melt on a plate, all at one temperature, flowing or about to.
Engine melt_block(double temperature) {
  const Mixture mixture = paper_mixture();
  const double dx = 10e-6, volume = dx * dx * dx;
  Particles particles;
  particles.spacing = dx;
  for (int k = 0; k < 8; ++k) {
    for (int j = 0; j < 10; ++j) {
      for (int i = 0; i < 10; ++i) {
        const double t = k < 4 ? 1500 : temperature;
        particles.add(static_cast<std::int64_t>(particles.size()),
                      {(i + 0.5) * dx, (j + 0.5) * dx, (k - 3.5) * dx}, mixture.density(0) * volume,
                      volume, mixture.enthalpy(t, 0), 0, Origin::plate);
      }
    }
  }
  Model model;
  model.conduction = model.species = false;
  model.flow = FlowSettings{};
  model.domain.lower = {-1e-3, -1e-3, -40e-6};
  model.domain.upper = {1e-3, 1e-3, 1e-3};
  return {std::move(particles), mixture, liquid_metal(), model};
}

}  // namespace

TEST(Flow, ANumberThatIsNoneNamesParticleAndTerm) {
  Engine engine = melt_block(2000);
  const std::size_t n = engine.particles().size();
  std::vector<Vector> velocity(n);
  std::vector<double> density(n, engine.mixture().density(0));
  density[640] = std::numeric_limits<double>::quiet_NaN();
  engine.set_state(velocity, density);
  try {
    engine.step(1e-6);
    FAIL() << "a density that is no number went unnoticed";
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("particle"), std::string::npos) << text;
    EXPECT_NE(text.find("continuity"), std::string::npos) << text;
  }
}

TEST(Flow, AParticleThatIsThrownOutStopsTheRunAndIsNamed) {
  Engine engine = melt_block(2000);
  const std::size_t n = engine.particles().size();
  std::vector<Vector> velocity(n);
  std::vector<double> density(n, engine.mixture().density(0));
  density[640] = 1e9;
  engine.set_state(velocity, density);
  try {
    engine.step(1e-6);
    FAIL() << "a pressure of 2e12 Pa went unnoticed";
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    for (const char* part :
         {"particle ", "spacings within a few steps", "pressure", "may hold it"}) {
      EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
    }
    int id = -1;
    double x = 0, y = 0, z = 0, moved = 0;
    ASSERT_EQ(std::sscanf(text.substr(text.find("particle ")).c_str(),
                          "particle %d, last listed at (%lf, %lf, %lf) um: it moved by %lf", &id,
                          &x, &y, &z, &moved),
              5)
        << text;
    EXPECT_NEAR(x, (id % 10 + 0.5) * 10, 1e-9) << text;
    EXPECT_NEAR(y, (id / 10 % 10 + 0.5) * 10, 1e-9) << text;
    EXPECT_NEAR(z, (id / 100 - 3.5) * 10, 1e-9) << text;
    EXPECT_LT(std::hypot(x - 5, y - 45, z - 25), 30) << "far from the cause: " << text;
    EXPECT_GT(moved, 1);
    EXPECT_LT(moved, 20);
  }
}

// A single particle in flight cools as a sphere of its volume does: m dh/dt = -A (q_evaporation +
// q_radiation). Without an area of its own it would heat under the beam without end.
TEST(Flow, SprayCoolsAsASphereDoes) {
  const Mixture mixture = paper_mixture();
  const double dx = 10e-6, volume = dx * dx * dx, hot = 3600;
  Particles particles;
  particles.spacing = dx;
  particles.add(0, {0, 0, 0.5e-3}, mixture.density(0) * volume, volume, mixture.enthalpy(hot, 0), 0,
                Origin::plate);
  Model model;
  model.conduction = model.species = false;
  model.flow = FlowSettings{};
  model.flow->gravity = {};
  model.surface_loss.emplace();
  model.domain.lower = {-1e-3, -1e-3, -1e-3};
  model.domain.upper = {1e-3, 1e-3, 1e-3};
  Engine engine(std::move(particles), mixture, liquid_metal(), model);
  const double end = 20e-6;
  for (int k = 1; k <= 200; ++k) {  // below the step that stability alone would allow
    while (engine.time() < k * end / 200) {
      engine.step(k * end / 200);
    }
  }
  const double area = std::cbrt(36 * std::numbers::pi * volume * volume);
  const double mass = mixture.density(0) * volume;
  const int steps = 20000;
  double enthalpy = mixture.enthalpy(hot, 0), temperature = hot;
  for (int k = 0; k < steps; ++k) {
    enthalpy -= end / steps * area / mass *
                (evaporation_flux(temperature, 0, mixture, 101325) +
                 radiation_flux(temperature, mixture.emissivity(0), 293.15));
    temperature = mixture.temperature(enthalpy, 0);
  }
  ASSERT_LT(temperature, 3300);
  EXPECT_NEAR(engine.particles().temperature[0], temperature, 0.01 * (hot - temperature));
}

TEST(Flow, SolidStandsStillAndMeltFreezesOntoIt) {
  Engine engine = melt_block(2000);
  std::size_t liquid = 0;
  for (const Phase phase : engine.particles().phase) {
    liquid += phase == Phase::liquid ? 1 : 0;
  }
  EXPECT_EQ(liquid, 400U);
  while (engine.time() < 5e-6) {
    engine.step(5e-6);
  }
  const Particles& p = engine.particles();
  double moved = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto id = static_cast<int>(p.identity[i]);
    const Vector start{(id % 10 + 0.5) * 10e-6, (id / 10 % 10 + 0.5) * 10e-6,
                       (id / 100 - 3.5) * 10e-6};
    const double way = std::hypot(p.position[i][0] - start[0], p.position[i][1] - start[1],
                                  p.position[i][2] - start[2]);
    if (p.phase[i] == Phase::solid) {
      EXPECT_EQ(way, 0);
      EXPECT_EQ(p.velocity[i], Vector{});
    } else {
      moved = std::max(moved, way);
      EXPECT_GT(p.position[i][2], -2e-6) << "melt within the solid";
    }
  }
  // Surface tension pulls the edges of the block in.
  EXPECT_GT(moved, 1e-7);
  EXPECT_EQ(engine.lost(), 0U);
}

}  // namespace meltproof::solver

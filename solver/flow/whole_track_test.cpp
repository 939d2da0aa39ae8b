// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include <gtest/gtest.h>
#include <omp.h>

#include "solver/flow/free_surface.hpp"
#include "solver/step/engine.hpp"

namespace meltproof::solver {

// Heat, species, mass and bytes of a track with everything on: a beam melts grains and plate, the
// melt flows under recoil and Marangoni forces, evaporates and freezes.
TEST(FreeSurfaceFlow, ATrackKeepsEnergySpeciesAndMass) {
  const Mixture mixture{read_material("data/materials/316L.toml"),
                        read_material("data/materials/AlSi10Mg.toml")};
  const double d = 10e-6, volume = d * d * d;
  const auto run = [&](int threads) {
    omp_set_num_threads(threads);
    Particles particles;
    particles.spacing = d;
    for (int k = 0; k < 9; ++k) {
      for (int j = 0; j < 16; ++j) {
        for (int i = 0; i < 20; ++i) {
          const bool grain = k == 8 && i > 6 && i < 13 && j > 5 && j < 10 && (i + j) % 3 != 0;
          if (k < 8 || grain) {
            particles.add(static_cast<std::int64_t>(particles.size()),
                          {(i + 0.5) * d, (j + 0.5) * d, (k - 7.5) * d},
                          mixture.density(grain ? 1 : 0) * volume, volume,
                          mixture.enthalpy(300, grain ? 1 : 0), grain ? 1 : 0,
                          grain ? Origin::additive_powder : Origin::plate);
          }
        }
      }
    }
    Model model;
    model.domain.lower = {0, 0, -80e-6};
    model.domain.upper = {200e-6, 160e-6, 10e-6};
    model.laser = Laser{
        .power = 175, .radius = 40e-6, .speed = 0.375, .start_x = 80e-6, .y = 80e-6, .exposure = 1};
    model.surface_loss = SurfaceLossSettings{};
    model.flow = FlowSettings{};
    Engine engine(std::move(particles), mixture,
                  read_diffusivity("data/materials/diffusivity.toml", "liquid_metal"), model);
    const double enthalpy = engine.total_enthalpy(), additive = engine.total_additive_mass();
    double mass = 0, mass_after = 0;
    for (const double m : engine.particles().mass) {
      mass += m;
    }
    while (engine.time() < 5e-5) {
      engine.step(5e-5);
    }
    // Particles change places, so masses are added up in the order of what they are.
    std::vector<double> sorted = engine.particles().mass;
    std::sort(sorted.begin(), sorted.end());
    for (const double m : sorted) {
      mass_after += m;
    }
    const EnergyLedger& ledger = engine.ledger();
    EXPECT_GT(engine.flow().liquid().size(), 100U) << "the test is to melt";
    EXPECT_GT(ledger.evaporated, 0) << "and to evaporate";
    EXPECT_NEAR((engine.total_enthalpy() - enthalpy) /
                    (ledger.absorbed - ledger.evaporated - ledger.radiated - ledger.convected),
                1, 1e-10);
    EXPECT_NEAR(engine.total_additive_mass() / additive, 1, 1e-12);
    EXPECT_NEAR(mass_after / mass, 1, 1e-13);
    omp_set_num_threads(1);
    return engine;
  };
  const Engine one = run(1), two = run(2);
  EXPECT_EQ(one.particles().position, two.particles().position);
  EXPECT_EQ(one.particles().velocity, two.particles().velocity);
  EXPECT_EQ(one.particles().enthalpy, two.particles().enthalpy);
  EXPECT_EQ(one.particles().concentration, two.particles().concentration);
}

}  // namespace meltproof::solver

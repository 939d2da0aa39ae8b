// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/multiphase/gas.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace meltproof::solver {
namespace {

constexpr double spacing = 4e-6, radius = 5 * spacing, density = 7430, tension = 1.82;

double distance(const Vector& at) { return std::hypot(at[0], at[1], at[2]); }

/// An eighth of a drop of molten metal in the corner of a box of eight spacings.
Particles eighth_of_a_drop() {
  Particles drop;
  drop.spacing = spacing;
  const double volume = spacing * spacing * spacing;
  for (int k = 0; k < 5; ++k) {
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 5; ++i) {
        const Vector at{(i + 0.5) * spacing, (j + 0.5) * spacing, (k + 0.5) * spacing};
        if (distance(at) < radius) {
          drop.add(static_cast<std::int64_t>(drop.size()), at, density * volume, volume, 0, 0,
                   Origin::plate);
          drop.phase.back() = Phase::liquid;
        }
      }
    }
  }
  return drop;
}

}  // namespace

TEST(GasFlow, HoldsADropOfMetalAtTwentyTimesTheGassDensity) {
  Particles drop = eighth_of_a_drop();
  Domain box;
  box.upper = {8 * spacing, 8 * spacing, 5 * spacing};
  for (auto& faces : box.face) {
    faces = {Face::mirror, Face::mirror};
  }
  FlowSettings settings;
  settings.gravity = {};
  GasFlow flow(drop, box, settings, {.density_ratio = 20, .height = 3 * spacing});
  EXPECT_EQ(flow.gas_particles(), 8 * 8 * 8 - drop.size());
  const auto melt = [&](std::uint32_t) {
    return MeltProperties{.viscosity = 0.06, .surface_tension = tension, .recoil = 0};
  };
  // The drop starts without its pressure and breathes with a period of some 25 us.
  constexpr int parts = 20;
  constexpr double time = 10e-6;
  double inside = 0, outside = 0;
  for (int part = 0; part < parts; ++part) {
    flow.advance(drop, melt, time / parts);
    const Particles& all = flow.flow().particles();
    double p_in = 0, p_out = 0, n_in = 0, n_out = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double r = distance(all.position[i]), p = flow.flow().pressure()[i];
      if (r < radius - 2.5 * spacing) {
        EXPECT_EQ(all.phase[i], Phase::liquid) << "gas has come into the drop";
        p_in += p;
        n_in += 1;
      } else if (r > radius + 2.5 * spacing) {
        EXPECT_EQ(all.phase[i], Phase::gas) << "metal has left the drop";
        p_out += p;
        n_out += 1;
      }
    }
    inside += p_in / n_in / parts;
    outside += p_out / n_out / parts;
  }
  EXPECT_NEAR((inside - outside) / (2 * tension / radius), 1, 0.4);
  double farthest = 0;
  for (const Vector& at : drop.position) {
    farthest = std::max(farthest, distance(at));
  }
  EXPECT_LT(farthest, radius + spacing);
}

}  // namespace meltproof::solver

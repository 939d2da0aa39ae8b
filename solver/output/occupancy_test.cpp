// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/occupancy.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "solver/output/acceptance.hpp"

namespace meltproof::solver {
namespace {

constexpr double dx = 10e-6;

void add(Particles& p, const Vector& at, Phase phase, double volume = dx * dx * dx) {
  p.add(static_cast<std::int64_t>(p.size()), at, 1, volume, 0, 0, Origin::plate);
  p.phase.back() = phase;
  p.melted.back() = phase == Phase::liquid ? 1 : 0;
}

/// A lattice over the box of n cells a side, z from -n dx to 0, chosen by `phase(at)`; Phase::lost
/// leaves a place empty.
template <class Choose>
Particles lattice(int n, const Choose& phase, double scale = 1) {
  Particles p;
  p.spacing = dx;
  for (int k = -n; k < 0; ++k) {
    for (int j = -n / 2; j < n / 2; ++j) {
      for (int i = -n / 2; i < n / 2; ++i) {
        const Vector at{scale * (i + 0.5) * dx, scale * (j + 0.5) * dx, scale * (k + 0.5) * dx};
        if (phase(at) != Phase::lost) {
          add(p, at, phase(at));
        }
      }
    }
  }
  return p;
}

double ratio(const Particles& p) {
  const MetalGrid grid(p);
  std::vector<std::uint8_t> chosen(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    chosen[i] = p.phase[i] == Phase::liquid ? 1 : 0;
  }
  const FilledVolume v = fill(grid, p, chosen);
  return v.filled / v.mass_volume;
}

double radius(const Vector& at, const Vector& centre) {
  return std::hypot(at[0] - centre[0], at[1] - centre[1], at[2] - centre[2]);
}

/// A drop with its centre off the lattice, all liquid.
Particles drop(double spacings, double scale = 1) {
  const Vector centre{0.2 * dx, -0.1 * dx, -(spacings + 2.3) * dx};
  return lattice(
      2 * static_cast<int>(spacings + 3),
      [&](const Vector& at) {
        return radius(at, {scale * centre[0], scale * centre[1], scale * centre[2]}) <
                       scale * spacings * dx
                   ? Phase::liquid
                   : Phase::lost;
      },
      scale);
}

Phase pool(const Vector& at) {
  return radius(at, {0, 0, 0}) < 5.3 * dx ? Phase::liquid : Phase::solid;
}

}  // namespace

TEST(Occupancy, ColourIsOneInsideAndOneHalfOnAFlatSurface) {
  const Particles p = lattice(14, [](const Vector&) { return Phase::solid; });
  const MetalGrid grid(p);
  double inside = 0, surface = 0;
  for (int i = 0; i < 16; ++i) {
    const double x = (i % 4 + 0.5) * dx / 4, y = (i / 4 + 0.5) * dx / 4;
    inside += colour(grid, p, {x, y, -7 * dx + 0.3 * x}) / 16;
    surface += colour(grid, p, {x, y, 0}) / 16;
  }
  EXPECT_NEAR(inside, 1, 0.01);
  EXPECT_NEAR(surface, 0.5, 0.01);
}

TEST(Occupancy, AnUndisturbedPoolInASolidFillsItsMass) {
  EXPECT_NEAR(ratio(lattice(14, pool)), 1, 1e-2);
  // Nothing but lattice on every side: only sub-cells are counted.
  const Vector middle{0, 0, -7 * dx};
  EXPECT_NEAR(ratio(lattice(14,
                            [&](const Vector& at) {
                              return radius(at, middle) < 4 * dx ? Phase::liquid : Phase::solid;
                            })),
              1, 1e-3);
}

TEST(Occupancy, DropsFillTheirMass) {
  // Curvature moves c = 1/2 inwards: short by 0.66 (spacing / radius)^2, as measured.
  EXPECT_NEAR(ratio(drop(5)), 1 - 0.66 / 25, 0.005);
  EXPECT_NEAR(ratio(drop(8)), 1 - 0.66 / 64, 0.005);
}

TEST(Occupancy, LoneParticlesFillTheirOwnVolume) {
  Particles p;
  p.spacing = dx;
  for (int i = 0; i < 30; ++i) {
    add(p, {5.37 * i * dx, 0.213 * i * dx, 0.117 * i * dx}, Phase::liquid);
  }
  EXPECT_NEAR(ratio(p), 1, 0.02);
}

TEST(Occupancy, DisorderWithoutClumpsChangesLittle) {
  Particles p = lattice(14, pool);
  std::mt19937_64 random(7);
  std::normal_distribution<double> shift(0, 0.2 * dx);
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.phase[i] == Phase::liquid) {
      for (double& x : p.position[i]) {
        x += shift(random);
      }
    }
  }
  EXPECT_NEAR(ratio(p), 1, 0.03);
}

TEST(Occupancy, AMeltThatSankInIsSeen) {
  // A lattice squeezed to four fifths of its volume, as an open drop.
  EXPECT_NEAR(ratio(drop(8, std::cbrt(0.8))), 0.8, 0.04);
}

TEST(Occupancy, PairsHalveTheUnionOfSpheresAndKeepTheVolume) {
  // A lattice of pairs as dense as the lattice of single particles.
  const Particles p = drop(8);
  const double pair = std::cbrt(2.0);
  Particles pairs;
  pairs.spacing = dx;
  const Vector centre{0.2 * dx, -0.1 * dx, -10.3 * dx};
  for (int k = -8; k <= 8; ++k) {
    for (int j = -8; j <= 8; ++j) {
      for (int i = -8; i <= 8; ++i) {
        const Vector at{centre[0] + pair * i * dx, centre[1] + pair * j * dx,
                        centre[2] + pair * k * dx};
        if (radius(at, centre) < 8 * dx) {
          add(pairs, {at[0] - 0.05 * dx, at[1], at[2]}, Phase::liquid);
          add(pairs, {at[0] + 0.05 * dx, at[1], at[2]}, Phase::liquid);
        }
      }
    }
  }
  const MetalGrid grid(pairs);
  const std::vector<std::uint8_t> all(pairs.size(), 1);
  const FilledVolume v = fill(grid, pairs, all);
  EXPECT_NEAR(v.filled / v.mass_volume, 1, 0.05);
  EXPECT_NEAR(v.union_of_spheres / (lattice_union_of_spheres * v.mass_volume), 0.67, 0.01);
  EXPECT_NEAR(measure_nearest(grid, pairs, all).clumped, 1, 0);
  const std::vector<std::uint8_t> whole(p.size(), 1);
  const FilledVolume even = fill(MetalGrid(p), p, whole);
  // Particles at the surface share fewer lenses.
  EXPECT_NEAR(even.union_of_spheres / (lattice_union_of_spheres * even.mass_volume), 1.04, 0.01);
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/solidification_csv.hpp"

#include <cmath>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace meltproof::solver {
namespace {

constexpr double dx = 10e-6;

double melt(const Vector& x) { return 1e-4 + 2 * x[0] + 0.3 * x[1]; }
double freeze(const Vector& x) { return 4e-4 + 2.2 * x[0] - 0.5 * x[1] + 0.1 * x[2]; }
double rate(const Vector& x) { return 1e6 + 1e9 * x[1] - 2e9 * x[2]; }
double gradient(const Vector& x) { return 1e7 + 3e10 * x[2]; }

/// A plate whose upper half has melted and frozen, with fields linear in space; places disordered
/// there by a fifth of a spacing.
FrozenTrack track() {
  FrozenTrack t;
  Particles& p = t.particles;
  p.spacing = dx;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> shift(-0.2 * dx, 0.2 * dx);
  for (int k = -10; k < 0; ++k) {
    for (int j = -5; j < 5; ++j) {
      for (int i = 0; i < 12; ++i) {
        Vector at{(i + 0.5) * dx, (j + 0.5) * dx, (k + 0.5) * dx};
        const bool frozen = k >= -5;
        for (double& x : at) {
          x += frozen ? shift(random) : 0;
        }
        p.add(static_cast<std::int64_t>(p.size()), at, 1, dx * dx * dx, 0, 0, Origin::plate);
        if (frozen) {
          p.melt_time.back() = melt(at);
          p.freeze_time.back() = freeze(at);
          p.cooling_rate.back() = rate(at);
          p.freeze_gradient.back() = gradient(at);
        }
      }
    }
  }
  return t;
}

}  // namespace

TEST(SolidificationCsv, ALinearFieldIsReproducedInside) {
  const auto points = interpolate(track(), 2.5e-6);
  std::size_t inside = 0;
  for (const auto& point : points) {
    const auto& x = point.at;
    if (x[0] > 20e-6 && x[0] < 100e-6 && std::abs(x[1]) < 30e-6 && x[2] > -35e-6 && x[2] < -15e-6) {
      ++inside;
      EXPECT_NEAR(point.melt_time, melt(x), 1e-12);
      EXPECT_NEAR(point.freeze_time, freeze(x), 1e-12);
      EXPECT_NEAR(point.cooling_rate, rate(x), 1e-3);
      EXPECT_NEAR(point.gradient, gradient(x), 1e-2);
    }
    // At the edges values stay within those of the particles near by.
    EXPECT_GE(point.cooling_rate, 1e6 - 1e9 * 52e-6);
    EXPECT_GT(point.freeze_time, point.melt_time);
  }
  EXPECT_GT(inside, 31U * 23 * 7 - 1);
}

TEST(SolidificationCsv, OnlyFrozenMaterialIsOnTheGridAndTheGridIsRegular) {
  const double cell = 2.5e-6;
  const auto points = interpolate(track(), cell);
  double lowest = 0;
  for (const auto& point : points) {
    for (const double x : point.at) {
      EXPECT_NEAR(x / cell, std::round(x / cell), 1e-9);
    }
    lowest = std::min(lowest, point.at[2]);
  }
  EXPECT_NEAR(lowest, -5 * dx, 0.5 * dx);
  // A frozen block of 12 x 10 x 5 spacings, its free surfaces known to some tenths of a spacing.
  EXPECT_NEAR(static_cast<double>(points.size()) * cell * cell * cell / (600 * dx * dx * dx), 1.1,
              0.12);
  EXPECT_LT(interpolate(track(), 2 * dx).size(), points.size() / 300);
}

TEST(SolidificationCsv, TheTablesHaveTheirColumns) {
  const auto points = interpolate(track(), dx);
  std::istringstream exaca(exaca_csv(points)), map(gradient_csv(points));
  std::string line;
  std::getline(exaca, line);
  EXPECT_EQ(line, "x,y,z,tm,ts,cr");
  std::getline(map, line);
  EXPECT_EQ(line, "x,y,z,ts,cr,g,v");
  std::size_t lines = 0;
  while (std::getline(map, line)) {
    std::istringstream cells(line);
    std::vector<double> v;
    for (std::string cell; std::getline(cells, cell, ',');) {
      v.push_back(std::stod(cell));
    }
    ASSERT_EQ(v.size(), 7U);
    EXPECT_NEAR(v[6] / (v[4] / v[5]), 1, 1e-4);
    ++lines;
  }
  EXPECT_EQ(lines, points.size());
}

TEST(SolidificationCsv, NothingFrozenGivesNoPlaces) {
  FrozenTrack t = track();
  for (auto& phase : t.particles.phase) {
    phase = Phase::liquid;
  }
  EXPECT_TRUE(interpolate(t, dx).empty());
}

TEST(SolidificationCsv, ACellThatMakesNoSenseIsRefused) {
  EXPECT_THROW(interpolate(track(), 0), InputError);
  EXPECT_THROW(interpolate(track(), 1e-8), InputError);
  EXPECT_THROW(read_frozen_track("README.md"), InputError);
}

}  // namespace meltproof::solver

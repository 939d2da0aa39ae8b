// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/terms/surface.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace meltproof::solver {
namespace {

constexpr double dx = 10e-6;
constexpr std::size_t side = 24, layers = 30;
const Vector lower{0, 0, 0}, upper{side * dx, side*dx, 0};

/// A block of metal whose places are a little off the lattice, with its surface near z = 0.
Particles block(std::mt19937& random) {
  std::uniform_real_distribution<double> off(-0.2 * dx, 0.2 * dx);
  Particles particles;
  particles.spacing = dx;
  for (std::size_t k = 0; k < layers; ++k) {
    for (std::size_t j = 0; j < side; ++j) {
      for (std::size_t i = 0; i < side; ++i) {
        particles.add(static_cast<std::int64_t>(particles.size()),
                      {(static_cast<double>(i) + 0.5) * dx + off(random),
                       (static_cast<double>(j) + 0.5) * dx + off(random),
                       -(static_cast<double>(k) + 0.5) * dx + off(random)},
                      1e-12, dx * dx * dx, 0, 0, Origin::plate);
      }
    }
  }
  return particles;
}

void expect_same(SurfaceSearch& search, const Particles& particles, const Slant& slant) {
  EXPECT_EQ(search.find(particles, lower, upper, slant, {}).top,
            find_surface(particles, lower, upper, slant).top);
}

}  // namespace

TEST(Surface, TheSearchFindsWhatLookingAtAllFinds) {
  std::mt19937 random(7);
  for (const Slant slant : {Slant{}, Slant{0.5, -0.3}}) {
    Particles particles = block(random);
    SurfaceSearch search;
    expect_same(search, particles, slant);
    // A pit that deepens far beyond the layers that are looked at first, whose metal comes up again
    // elsewhere; deep metal joins those that move, and rises too.
    std::vector<std::uint32_t> moving;
    std::normal_distribution<double> jump(0, 0.5 * dx);
    for (std::size_t step = 0; step < 60; ++step) {
      const double depth = static_cast<double>(step) * 0.4 * dx;
      std::vector<std::uint32_t> joined;
      for (std::uint32_t i = 0; i < particles.size(); ++i) {
        const Vector& at = particles.position[i];
        if (std::hypot(at[0] - 12 * dx, at[1] - 12 * dx) < 5 * dx && at[2] > -depth) {
          joined.push_back(i);
        }
      }
      search.moves(joined);
      moving.insert(moving.end(), joined.begin(), joined.end());
      for (const std::uint32_t i : moving) {
        for (double& x : particles.position[i]) {
          x += jump(random);
        }
      }
      for (const std::uint32_t i : joined) {
        particles.position[i][0] += step % 2 == 0 ? 8 * dx : 0;
      }
      expect_same(search, particles, slant);
    }
  }
}

TEST(Surface, ColumnsWithoutMetalStayBareUntilSomeMovesThere) {
  std::mt19937 random(3);
  Particles particles = block(random);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    particles.position[i][0] *= 0.5;  // nobody in the other half
  }
  SurfaceSearch search;
  expect_same(search, particles, {});
  search.moves({5000});
  particles.position[5000] = {20 * dx, 12 * dx, -25 * dx};
  expect_same(search, particles, {});
  particles.position[5000][2] = 3 * dx;
  expect_same(search, particles, {});
}

// Between ranks particles come and go, and entries are used again: as Engine::rebuild_lists() tells
// the search.
TEST(Surface, WhoComesToAFreeEntryIsSeenAndWhoLeavesIsNot) {
  std::mt19937 random(11);
  Particles particles = block(random);
  std::uniform_int_distribution<std::uint32_t> any(
      0, static_cast<std::uint32_t>(particles.size()) - 1);
  std::uniform_real_distribution<double> where(0.5 * dx, (side - 0.5) * dx), high(-5 * dx, 2 * dx);
  for (std::uint32_t i = 0; i < particles.size(); i += 7) {
    particles.home[i] = Home::nowhere;
  }
  SurfaceSearch search;
  expect_same(search, particles, {});
  for (int round = 0; round < 40; ++round) {
    std::vector<std::uint32_t> entries;
    for (int k = 0; k < 60; ++k) {
      const std::uint32_t i = any(random);
      entries.push_back(i);
      if (particles.home[i] == Home::nowhere) {
        // It stands still here, so nobody counts it among those that move.
        particles.home[i] = Home::here;
        particles.position[i] = {where(random), where(random), high(random)};
      } else {
        particles.home[i] = Home::nowhere;
      }
    }
    search.moves(entries);
    expect_same(search, particles, {});
  }
}

TEST(Surface, WhatIsLostCastsNoShadow) {
  std::mt19937 random(5);
  Particles particles = block(random);
  // Beyond the sky, above the middle.
  particles.position[4000] = {12 * dx, 12 * dx, 100 * dx};
  const auto count = [&] {
    const auto columns = find_surface(particles, lower, upper);
    return std::count(columns.top.begin(), columns.top.end(), 4000U);
  };
  EXPECT_EQ(count(), 4);
  particles.phase[4000] = Phase::lost;
  EXPECT_EQ(count(), 0);
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/acceptance.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace meltproof::solver {
namespace {

constexpr double dx = 5e-6;

/// A plate 30 x 12 x 8 spacings with its surface at z = 0; a melted track 4 spacings deep along x.
/// `surface(x)` is the height in spacings above which there is nothing.
Particles plate(const std::function<double(double)>& surface) {
  Particles p;
  p.spacing = dx;
  for (int k = -8; k < 4; ++k) {
    for (int j = -6; j < 6; ++j) {
      for (int i = 0; i < 30; ++i) {
        const Vector at{(i + 0.5) * dx, (j + 0.5) * dx, (k + 0.5) * dx};
        const bool track = std::abs(at[1]) < 3 * dx && at[2] > -4 * dx;
        if (k + 0.5 > (track ? surface(i + 0.5) : 0)) {
          continue;
        }
        p.add(static_cast<std::int64_t>(p.size()), at, 1, dx * dx * dx, 0, 0, Origin::plate);
        p.melted.back() = track ? 1 : 0;
        p.phase.back() = track ? Phase::liquid : Phase::solid;
      }
    }
  }
  return p;
}

Particles flat() {
  return plate([](double) { return 0.0; });
}

AcceptanceSettings settings() {
  AcceptanceSettings s;
  s.lower = {-dx, -7 * dx, -9 * dx};
  s.upper = {31 * dx, 7 * dx, 9 * dx};
  s.from = 4 * dx;
  s.to = 26 * dx;
  s.width = 2 * dx;
  return s;
}

/// The same particles in another order in memory.
Particles shuffled(const Particles& p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), 0U);
  std::shuffle(order.begin(), order.end(), std::mt19937_64(3));
  Particles q;
  q.spacing = p.spacing;
  for (const std::size_t i : order) {
    q.add(p.identity[i], p.position[i], p.mass[i], p.volume[i], 0, 0, p.origin[i]);
    q.phase.back() = p.phase[i];
    q.melted.back() = p.melted[i];
  }
  return q;
}

}  // namespace

TEST(Acceptance, AnUndisturbedTrackPasses) {
  const Acceptance a = measure_acceptance(flat(), settings());
  EXPECT_TRUE(a.pass()) << a.table();
  EXPECT_EQ(a.lost, 0U);
  EXPECT_EQ(a.liquid.clumped, 0);
  EXPECT_NEAR(a.liquid.smallest, 1, 1e-9);
  EXPECT_NEAR(a.liquid.median, 1, 1e-9);
  EXPECT_NEAR(a.height.mean / dx, 0, 0.05);
  EXPECT_NEAR(a.height.deepest / dx, 0, 0.1);
  EXPECT_NEAR(a.liquid_volume.filled / a.liquid_volume.mass_volume, 1, 0.01);
  EXPECT_EQ(a.ever_melted.particles, 30U * 6 * 4);
}

TEST(Acceptance, ClumpedMeltFails) {
  Particles p = flat();
  std::size_t moved = 0, liquid = 0;
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    liquid += p.phase[i] == Phase::liquid ? 1 : 0;
    // Of every tenth pair along x one particle sits upon the other.
    if (p.phase[i] == Phase::liquid && p.phase[i + 1] == Phase::liquid && i % 20 == 0) {
      p.position[i] = p.position[i + 1];
      p.position[i][0] += 0.3 * dx;
      moved += 2;
    }
  }
  const Acceptance a = measure_acceptance(p, settings());
  EXPECT_FALSE(a.pass());
  EXPECT_NEAR(a.liquid.clumped, static_cast<double>(moved) / static_cast<double>(liquid), 0.01);
  EXPECT_NEAR(a.liquid.smallest, 0.3, 1e-9);
  EXPECT_EQ(clumped_fraction(p), a.liquid.clumped);
  EXPECT_NE(a.table().find("NOT HELD"), std::string::npos) << a.table();
}

TEST(Acceptance, TheMeanOfAWindowIsJudgedInPlaceOfTheInstant) {
  Acceptance a = measure_acceptance(flat(), settings());
  a.clumped_mean = 0.02;  // two pairs in a hundred, though none at this instant
  EXPECT_FALSE(a.pass());
  EXPECT_NE(a.table().find("2.00 %"), std::string::npos) << a.table();
  EXPECT_EQ(a.json()["liquid"]["clumped_fraction_mean"], 0.02);
  a.liquid.clumped = 0.5;
  a.clumped_mean = 0.005;
  EXPECT_TRUE(a.pass()) << a.table();
}

TEST(Acceptance, ALostParticleFails) {
  for (const int how : {0, 1, 2}) {
    Particles p = flat();
    if (how == 0) {
      p.phase[5] = Phase::lost;
    } else {
      p.position[5][2] = how == 1 ? 10 * dx : std::numeric_limits<double>::quiet_NaN();
    }
    const Acceptance a = measure_acceptance(p, settings());
    EXPECT_EQ(a.lost, 1U) << how;
    EXPECT_FALSE(a.pass());
  }
}

TEST(Acceptance, AMeltThatSankInFails) {
  // A fifth of the melt's volume is gone although nothing clumps: an even lattice, only lower.
  Particles p = flat();
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.phase[i] == Phase::liquid) {
      p.position[i][2] = -4 * dx + 0.8 * (p.position[i][2] + 4 * dx);
    }
  }
  const Acceptance a = measure_acceptance(p, settings());
  EXPECT_EQ(a.liquid.clumped, 0);
  EXPECT_FALSE(a.pass());
  EXPECT_NEAR(a.liquid_volume.filled / a.liquid_volume.mass_volume, 0.8, 0.05);
}

TEST(Acceptance, AnOpenTrenchFailsAndAPitIsFound) {
  const Acceptance trench = measure_acceptance(plate([](double) { return -2.0; }), settings());
  EXPECT_FALSE(trench.pass());
  EXPECT_NEAR(trench.height.mean / dx, -2, 0.1);
  EXPECT_EQ(trench.height.share_of_pits, 1);
  const Acceptance pit =
      measure_acceptance(plate([](double x) { return x > 14 && x < 17 ? -3.0 : 1.0; }), settings());
  EXPECT_TRUE(pit.pass()) << pit.table();  // one pit is reported, not refused
  EXPECT_NEAR(pit.height.deepest / dx, -3, 0.3);
  EXPECT_NEAR(pit.height.lowest_mean / dx, -3, 0.3);
  EXPECT_NEAR(pit.height.mean / dx, 1 - 4.0 * 3 / 22, 0.1);
  // Outside the limits, as a start-up pit is, it does not count.
  AcceptanceSettings later = settings();
  later.from = 19 * dx;
  EXPECT_GT(measure_acceptance(plate([](double x) { return x > 14 && x < 17 ? -3.0 : 1.0; }), later)
                .height.deepest,
            0.8 * dx);
}

TEST(Acceptance, TheOrderInMemoryDoesNotMatter) {
  Particles p = flat();
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> shift(-0.4 * dx, 0.4 * dx);
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (double& x : p.position[i]) {
      x += p.melted[i] != 0 ? shift(random) : 0;
    }
  }
  const auto one = measure_acceptance(p, settings()).json(),
             two = measure_acceptance(shuffled(p), settings()).json();
  EXPECT_EQ(one.dump(), two.dump());
  EXPECT_GT(one["ever_melted"]["clumped_fraction"].get<double>(), 0.01);
}

TEST(Acceptance, WithoutMeltThereIsNothingToAsk) {
  Particles p = flat();
  for (std::size_t i = 0; i < p.size(); ++i) {
    p.phase[i] = Phase::solid;
    p.melted[i] = 0;
  }
  AcceptanceSettings s;
  const Acceptance a = measure_acceptance(p, s);
  EXPECT_TRUE(a.pass());
  EXPECT_FALSE(a.json().contains("refilled_track"));
  EXPECT_NE(a.table().find("none"), std::string::npos);
  EXPECT_TRUE(measure_acceptance({}, s).pass());
}

}  // namespace meltproof::solver

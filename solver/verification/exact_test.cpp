// SPDX-License-Identifier: GPL-3.0-or-later
// The exact solutions against what is known of them from elsewhere, so that a case does not pass
// because both sides share a mistake.
#include "solver/verification/exact.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "solver/verification/kinds.hpp"

namespace meltproof::solver {

TEST(Exact, NeumannWithoutSuperheatIsTheOnePhaseProblem) {
  for (const auto& [stefan, lambda] : {std::pair{0.1, 0.220016}, std::pair{0.5, 0.464786},
                                       std::pair{1.0, 0.620063}, std::pair{2.0, 0.800601}}) {
    EXPECT_NEAR(stefan_lambda(stefan), lambda, 1e-6);
    EXPECT_NEAR(neumann_lambda(stefan, 0, 3), lambda, 1e-6);
  }
}

TEST(Exact, NeumannBalancesTheHeatAtTheFront) {
  // Wall at 700 K, front at 600 K, far at 550 K; rho c = 1e6, L rho = 2e8.
  const double near = 5e-6, far = 1e-5, time = 1e-3;
  const NeumannSolution t{700, 600, 550, near, far, neumann_lambda(0.5, 0.5, 2)};
  const double spread = 2 * std::sqrt(near * time), front = t.lambda * spread, d = 1e-9;
  EXPECT_NEAR(t(front - d, time), 600, 0.01);
  EXPECT_NEAR(t(front + d, time), 600, 0.01);
  const double from_wall = -near * 1e6 * (t(front - d, time) - t(front - 2 * d, time)) / d;
  const double to_far = -far * 1e6 * (t(front + 2 * d, time) - t(front + d, time)) / d;
  const double speed = t.lambda * std::sqrt(near / time);
  EXPECT_NEAR(from_wall - to_far, 2e8 * speed, 1e-3 * 2e8 * speed);
}

TEST(Exact, EagarTsaiUnderAStandingBeamTendsToItsSteadyCentre) {
  const EagarTsai still{70, 40e-6, 0, 25, 5e-6, 300};
  const double steady = 300 + 70 / (std::sqrt(2 * std::numbers::pi) * 25 * 40e-6);
  EXPECT_NEAR(still(0, 0, 0, 1e3), steady, 1e-3 * steady);
  EXPECT_LT(still(0, 0, 0, 1e-3), steady);
}

TEST(Exact, EagarTsaiFarBehindTheBeamIsRosenthalsTail) {
  // On the track's line behind a point source T - T0 = aP/(2 pi k distance).
  const EagarTsai moving{70, 40e-6, 0.375, 25, 5e-6, 300};
  const double time = 1, distance = 3e-3;
  EXPECT_NEAR(moving(0.375 * time - distance, 0, 0, time) - 300,
              70 / (2 * std::numbers::pi * 25 * distance), 2);
}

TEST(Exact, EagarTsaiKeepsTheHeatThatWasAbsorbed) {
  // rho c times the integral of T - T0 over the half space is a P t.
  const EagarTsai beam{70, 40e-6, 0.375, 25, 5e-6, 300};
  const double time = 1e-4, step = 12e-6;
  double heat = 0;
  for (double z = step / 2; z < 200e-6; z += step) {
    for (double y = step / 2; y < 250e-6; y += step) {
      for (double x = -250e-6; x < 300e-6; x += step) {
        heat += 2 * (beam(x, y, z, time) - 300) * step * step * step * 5e6;
      }
    }
  }
  EXPECT_NEAR(heat / (70 * time), 1, 0.02);
}

TEST(Exact, AFilmThatRadiatesCoolsAsItsClosedFormSays) {
  // dT/dt = -b T^4: T = (T0^-3 + 3 b t)^(-1/3).
  const double b = 1e-10;
  const double cooled = cooling_film([&](double t) { return b * std::pow(t, 4); }, 1, 2000, 2);
  EXPECT_NEAR(cooled, std::pow(std::pow(2000., -3) + 6 * b, -1. / 3), 1e-6);
}

TEST(Kinds, AnUnknownKindIsRefusedWithTheNamesThatThereAre) {
  try {
    find_kind("stephan");
    FAIL();
  } catch (const InputError& refused) {
    EXPECT_NE(std::string(refused.what()).find("stefan_two_phase"), std::string::npos);
  }
}

TEST(Kinds, ARunThatBlowsUpIsAFailedCaseAndNotTheEndOfTheTable) {
  VerificationCase c;
  c.kind = "stefan";
  c.name = "blown_up";
  c.spacings = {10e-6, 20e-6};
  c.stefan = std::nan("");
  std::string profile;
  const auto row = verify(c, profile);
  EXPECT_FALSE(row["pass"].get<bool>());
  EXPECT_FALSE(row["broken"].empty());
}

}  // namespace meltproof::solver

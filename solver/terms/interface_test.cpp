// SPDX-License-Identifier: GPL-3.0-or-later
// The sums over neighbours that the free surface is read from, and the pair terms that are made for
// it.
#include "solver/terms/interface.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "solver/particles/kernel.hpp"
#include "solver/terms/continuity.hpp"
#include "solver/terms/viscosity.hpp"

namespace meltproof::solver {

TEST(Interface, TheDepthBelowAPlaneIsTheInverseOfItsColourGradient) {
  for (const int dimensions : {2, 3}) {
    const SurfaceDepth below(dimensions);
    for (const double depth : {0.3, 0.5, 0.9, 1.5, 1.9}) {
      EXPECT_NEAR(below(plane_colour_gradient(depth, dimensions)), depth, 1e-3);
    }
    // All of the kernel lies on one of the two sides.
    double share = 0;
    for (int i = 0; i < 3000; ++i) {
      share += 1e-3 * plane_colour_gradient((i + 0.5) * 1e-3, dimensions);
    }
    EXPECT_NEAR(share, 0.5, 1e-6);
  }
  EXPECT_NEAR(plane_colour_gradient(0.5, 3), 0.4461, 1e-4);
  EXPECT_NEAR(plane_colour_gradient(1.5, 2), 0.0578, 1e-4);
}

// A drop of one particle evaporates from all of its sphere (circle); what has a surface, from that.
TEST(Interface, SprayIsExposedAllAround) {
  const double volume = 1e-15, alone = 0.175;
  const double radius = std::cbrt(3 * volume / (4 * std::numbers::pi));
  const double sphere = 4 * std::numbers::pi * radius * radius;
  EXPECT_NEAR(exposed_area(0, alone, alone, volume, 3) / sphere, 1, 1e-12);
  EXPECT_NEAR(exposed_area(0, alone, alone, 1e-10, 2), 2 * std::sqrt(std::numbers::pi * 1e-10),
              1e-17);
  // A pair on the lattice: each has half of the sphere of both.
  const QuinticSpline kernel(1, 3);
  const double pair = exposed_area(0.27e-10, alone + kernel.value(1.0), alone, volume, 3);
  EXPECT_NEAR(pair / (sphere * std::cbrt(4.0) / 2), 1, 0.2);
  for (const double filled : {0.5, 0.56, 0.75, 1.0, 1.1}) {
    EXPECT_DOUBLE_EQ(exposed_area(1e-10, filled, alone, volume, 3), 1e-10);
  }
}

// The numbers on which exposed_area() rests: how full the kernel of a lattice's particles is, what
// a pair's colour gradient makes of its area, and what balls make of pairs and threads.
TEST(Interface, SprayAndLatticesAreToldApartByWhatFillsTheirKernels) {
  const QuinticSpline kernel(1, 3);
  double lattice = 0, corner = 0, edge = 0, face = 0;
  for (int i = -3; i <= 3; ++i) {
    for (int j = -3; j <= 3; ++j) {
      for (int k = -3; k <= 3; ++k) {
        const double w = kernel.value(std::sqrt(i * i + j * j + k * k));
        lattice += w;
        face += k <= 0 ? w : 0;
        edge += k <= 0 && j <= 0 ? w : 0;
        corner += k <= 0 && j <= 0 && i <= 0 ? w : 0;
      }
    }
  }
  EXPECT_NEAR(corner / lattice, 0.48, 0.005);
  EXPECT_NEAR(edge / lattice, 0.61, 0.005);
  EXPECT_NEAR(face / lattice, 0.78, 0.005);
  const double alone = kernel.value(0.0) / lattice, sphere = std::cbrt(36 * std::numbers::pi);
  // 2 |grad c| V of a pair a spacing apart.
  EXPECT_NEAR(-2 * kernel.slope(1.0) / sphere, 1.0 / 18, 0.001);
  const double pair = exposed_area(0, alone + kernel.value(1.0) / lattice, alone, 1, 3);
  EXPECT_NEAR(pair / (sphere * std::cbrt(4.0) / 2), 1.155, 0.005);
  double beside = 0;
  for (int i = 1; i <= 3; ++i) {
    beside += 2 * kernel.value(static_cast<double>(i)) / lattice;
  }
  const double thread = exposed_area(0, alone + beside, alone, 1, 3);
  EXPECT_NEAR(thread / (2 * std::sqrt(std::numbers::pi)), 1.13, 0.005);
}

// The colour gradient below a sphere (circle), by integrating the kernel over it, is that of the
// plane times 1 + kappa s/2, and the depth read off the plane falls short by per_curvature.
TEST(Interface, CurvatureMakesParticlesSeemShallowerByAKnownAmount) {
  const double radius = 20, s = 0.7, fine = 0.02;
  for (const int dimensions : {2, 3}) {
    const QuinticSpline kernel(1, dimensions);
    double gradient = 0;
    const auto reach = static_cast<int>(3 / fine);
    for (int k = dimensions == 3 ? -reach : 0; k <= (dimensions == 3 ? reach : 0); ++k) {
      for (int j = -reach; j < reach; ++j) {
        // Along the normal the sum is W at the sphere: what lies beyond pulls inward.
        const double x = (j + 0.5) * fine, y = k * fine;
        const double rest = radius * radius - x * x - y * y;
        const double z = std::sqrt(rest) - (radius - s);
        gradient += kernel.value(std::sqrt(x * x + y * y + z * z)) * std::pow(fine, dimensions - 1);
      }
    }
    const double kappa = (dimensions - 1) / radius, plane = plane_colour_gradient(s, dimensions);
    EXPECT_NEAR(gradient / plane, 1 + kappa * s / 2, 0.1 * kappa * s);
    const SurfaceDepth below(dimensions);
    EXPECT_NEAR(below(gradient) + kappa * below.per_curvature(gradient), s, 0.1 * kappa * s);
  }
}

TEST(Interface, CurvatureIsExactForTheNormalsOfASphereAtAnyDepth) {
  const double radius = 7, depth = 0.5;
  const Vector own{0, 0, 1};
  InterfaceSums sums;
  std::mt19937 random(3);
  for (int k = 0; k < 12; ++k) {
    const double angle = 0.3 * static_cast<double>(random()) / 4294967295.0 + 0.05,
                 turn = static_cast<double>(random()), its = k % 2 == 0 ? depth : 1.4;
    const Vector n{std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn),
                   std::cos(angle)};
    double bend = 0, along = 0;
    for (std::size_t d = 0; d < 2; ++d) {
      const double t = -(radius - its) * n[d];
      bend += -2 * (own[d] - n[d]) * t;
      along += -2 * t * t;
    }
    sums.turn += bend;
    sums.inset += its * bend;
    sums.reach += along;
  }
  bool limited = false;
  EXPECT_NEAR(surface_curvature(sums, 3, 0, 1, limited), 2 / radius, 1e-12);
  EXPECT_NEAR(surface_curvature(sums, 2, 0, 1, limited), 1 / radius, 1e-12);
  const double allowed = surface_curvature(sums, 3, 0.3, 1, limited);
  EXPECT_NEAR(2 / allowed, radius + 0.3 * allowed, 1e-12);
  EXPECT_FALSE(limited);
  EXPECT_NEAR(surface_curvature(sums, 3, 0, 20, limited), 2. / 20 * 2, 1e-12);
  EXPECT_TRUE(limited) << "a radius below half a spacing is held and counted";
}

TEST(Interface, TheGradientOfALinearFieldIsExactOnAnyNeighbours) {
  const Vector slope{3, -1, 2}, normal{0, 0.6, 0.8};
  InterfaceSums sums;
  std::mt19937 random(5);
  const auto number = [&] { return static_cast<double>(random()) / 2147483648.0 - 1; };
  for (int k = 0; k < 9; ++k) {
    const double x = number(), y = number(), z = number(), f = -1 - number() * 0.5;
    const double step = f * (slope[0] * x + slope[1] * y + slope[2] * z);
    sums.difference[0] += step * x;
    sums.difference[1] += step * y;
    sums.difference[2] += step * z;
    sums.moment[0] += f * x * x;
    sums.moment[1] += f * y * y;
    sums.moment[2] += f * z * z;
    sums.moment[3] += f * x * y;
    sums.moment[4] += f * x * z;
    sums.moment[5] += f * y * z;
  }
  const Vector whole = surface_gradient(sums, {}), along = surface_gradient(sums, normal);
  const double across = slope[1] * normal[1] + slope[2] * normal[2];
  for (std::size_t d = 0; d < 3; ++d) {
    EXPECT_NEAR(whole[d], slope[d], 1e-10);
    EXPECT_NEAR(along[d], slope[d] - across * normal[d], 1e-10);
  }
}

// Layers of the lattice below a plane surface, and the whole lattice.
TEST(Interface, TheOutermostLayerLacksAFifthOfAGradientAlongIt) {
  const QuinticSpline kernel(1, 3);
  for (const int layer : {0, 1, 3}) {
    double spread = 0;
    for (int i = -3; i <= 3; ++i) {
      for (int j = -3; j <= 3; ++j) {
        for (int k = -3; k <= layer; ++k) {
          const double r2 = i * i + j * j + k * k;
          spread += kernel.gradient_factor(r2) * (i * i + j * j);
        }
      }
    }
    EXPECT_NEAR(missing_support(spread, 3), layer == 0 ? 0.22 : layer == 1 ? 0.007 : 0.005, 0.005);
  }
  EXPECT_NEAR(missing_support(-1.2, 3), 0.4 / 2, 1e-12);
  EXPECT_NEAR(missing_support(-0.6, 2), 0.4 / 2, 1e-12);
  EXPECT_NEAR(missing_support(-1.28, 3), 0.36 * 0.9, 1e-12) << "fades between 0.35 and 0.45";
  EXPECT_EQ(missing_support(-0.5, 3), 0) << "spray";
  EXPECT_EQ(missing_support(-2.1, 3), 0) << "never pushes the other way";
}

TEST(DensityRelaxation, LeavesSprayAlone) {
  EXPECT_DOUBLE_EQ(density_excess(7100, 7000, 7000), 100);
  EXPECT_DOUBLE_EQ(density_excess(6900, 7000, 7000), -100);
  EXPECT_NEAR(density_excess(0.775 * 7000, 7000, 7000), -0.5 * 0.225 * 7000, 1e-9) << "half way";
  EXPECT_EQ(density_excess(4800, 7000, 7000), 0) << "few neighbours say nothing";
}

// The layers of a half-space cut from the lattice, undisturbed and with its rows pressed together:
// both sums grow alike, so their ratio must tell the depth and leave the density to the sum.
TEST(DensityRelaxation, AHalfSpaceHasItsDensityUpToTheSurface) {
  for (const int dimensions : {2, 3}) {
    const QuinticSpline kernel(1, dimensions);
    const SurfaceDepth depth(dimensions);
    for (const double pressed : {1.0, 0.9}) {
      for (const int layer : {0, 1, 2}) {
        double sum = 0, whole = 0, strength = 0;
        for (int k = -3; k <= 3; ++k) {
          for (int i = -4; i <= 4; ++i) {
            for (int j = dimensions == 3 ? -3 : 0; j <= (dimensions == 3 ? 3 : 0); ++j) {
              whole += kernel.value(std::sqrt(i * i + j * j + k * k));
              const double x = pressed * i, r = std::sqrt(x * x + j * j + k * k);
              if (k <= layer) {
                sum += kernel.value(r);
                strength += r > 0 ? kernel.slope(r) * k / r : 0;
              }
            }
          }
        }
        const double density = sum / whole / depth.covered(std::abs(strength) / (sum / whole));
        EXPECT_NEAR(density * pressed, 1, 0.002) << dimensions << " " << pressed << " " << layer;
      }
    }
  }
}

// sum V S (r . t)^2 (r . n)^2 is the shear viscosity of the lattice over eta, for velocities along
// t that grow along n.
TEST(Viscosity, TheLatticeIsAsViscousAlongItsAxesAsAlongItsDiagonals) {
  for (const int dimensions : {2, 3}) {
    const QuinticSpline kernel(1, dimensions);
    double axes = 0, diagonals = 0, moment = 0;
    for (int i = -3; i <= 3; ++i) {
      for (int j = -3; j <= 3; ++j) {
        for (int k = dimensions == 3 ? -3 : 0; k <= (dimensions == 3 ? 3 : 0); ++k) {
          const double r = std::sqrt(i * i + j * j + k * k);
          if (r > 0) {
            const double s =
                central_viscosity(kernel.slope(r) / r, kernel.second_moment, dimensions);
            axes -= s * i * i * j * j;
            diagonals -= s * (i + j) * (i + j) * (i - j) * (i - j) / 4;
          }
          moment += kernel.value(r) * r * r;
        }
      }
    }
    EXPECT_NEAR(axes, 1, 0.005);
    EXPECT_NEAR(diagonals, 1, 0.005);
    EXPECT_NEAR(moment / kernel.second_moment, 1, 0.005);
    EXPECT_DOUBLE_EQ(QuinticSpline(2, dimensions).second_moment, 4 * kernel.second_moment);
  }
}

TEST(DensityDiffusion, LeavesALinearProfileAndOnlyMovesDensityAbout) {
  const double g = 5, r = 0.7;
  EXPECT_EQ(density_diffusion_pair(7000 + g * r, 7000.0, g * r, 2.0, -0.3), 0);
  const double v_i = 2, v_j = 3;
  EXPECT_DOUBLE_EQ(v_i * density_diffusion_pair(7010.0, 7000.0, 1.0, v_j, -0.3),
                   -v_j * density_diffusion_pair(7000.0, 7010.0, -1.0, v_i, -0.3));
  EXPECT_DOUBLE_EQ(density_diffusion_pair(7010.0, 7000.0, 1.0, v_j, -0.3), -2 * v_j * 9 * 0.3);
}

TEST(NormalWeight, IsWholeOutsideAndFadesToNothingAtTheSecondLayer) {
  EXPECT_EQ(normal_weight(0.5, 1.0, 1.5), 1);
  EXPECT_EQ(normal_weight(1.0, 1.0, 1.5), 1);
  EXPECT_DOUBLE_EQ(normal_weight(1.2, 1.0, 1.5), 0.6);
  EXPECT_EQ(normal_weight(1.5, 1.0, 1.5), 0);
  EXPECT_EQ(normal_weight(1.8, 1.0, 1.5), 0);
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// What one particle collects from its neighbours, against the exact derivative or geometry.
#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "solver/multiphase/depth.hpp"
#include "solver/multiphase/interface.hpp"
#include "solver/multiphase/momentum.hpp"

namespace meltproof::solver {
namespace {

/// Calls body(place) for the lattice points around the origin, the origin left out.
template <class Body>
void around_origin(double spacing, const Body& body) {
  for (int i = -4; i <= 4; ++i) {
    for (int j = -4; j <= 4; ++j) {
      if (i != 0 || j != 0) {
        body(Components<2, double>{i * spacing, j * spacing});
      }
    }
  }
}

constexpr double spacing = 0.1, cell = spacing * spacing;

QuinticSpline lattice_kernel() {
  QuinticSpline kernel(spacing, 2);
  set_lattice_moments(kernel, spacing, 2, LatticeMoments::second);
  return kernel;
}

}  // namespace

TEST(MomentumPair, TurnsALinearPressureIntoItsGradient) {
  const QuinticSpline kernel = lattice_kernel();
  const double density = 3;
  const auto state = [&](const Components<2, double>& at) {
    return MomentumState<2, double>{{}, {}, cell, density, 7 + 2 * at[0] - 5 * at[1], 0};
  };
  MomentumSums<2, double> sums;
  around_origin(spacing, [&](const Components<2, double>& at) {
    const PairGeometry<2, double> pair({0, 0}, at);
    momentum_pair<2, double>(sums, pair, kernel, state({0, 0}), state(at));
  });
  const double mass = density * cell;
  // The first moment of the kernel's gradient is 1.0008 on this lattice.
  EXPECT_NEAR(sums.force[0] / mass, -2 / density, 2e-3);
  EXPECT_NEAR(sums.force[1] / mass, 5 / density, 5e-3);
  EXPECT_NEAR(sums.background[0], 0, 1e-15);
}

TEST(MomentumPair, TurnsAParabolaOfSpeedIntoItsLaplacian) {
  const QuinticSpline kernel = lattice_kernel();
  const double viscosity = 0.7;
  const auto state = [&](const Components<2, double>& at) {
    return MomentumState<2, double>{{at[1] * at[1], 3 * at[0]}, {}, cell, 1, 0, viscosity};
  };
  MomentumSums<2, double> sums;
  around_origin(spacing, [&](const Components<2, double>& at) {
    momentum_pair<2, double>(sums, PairGeometry<2, double>({0, 0}, at), kernel, state({0, 0}),
                             state(at));
  });
  EXPECT_NEAR(sums.force[0] / cell, 2 * viscosity, 1e-12);
  EXPECT_NEAR(sums.force[1] / cell, 0, 1e-12);
}

TEST(MomentumPair, CarriesTheMomentumThatTheTransportVelocityLeavesBehind) {
  // div(rho v (v~ - v)) with v = (x, 0) and v~ - v = (4, 0) is 4 rho along x.
  const QuinticSpline kernel = lattice_kernel();
  const double density = 3;
  const auto state = [&](const Components<2, double>& at) {
    return MomentumState<2, double>{{at[0], 0}, {4, 0}, cell, density, 0, 0};
  };
  MomentumSums<2, double> sums;
  around_origin(spacing, [&](const Components<2, double>& at) {
    momentum_pair<2, double>(sums, PairGeometry<2, double>({0, 0}, at), kernel, state({0, 0}),
                             state(at));
  });
  EXPECT_NEAR(sums.force[0] / cell, 4 * density, 0.002 * 4 * density);
}

TEST(WallPair, ShowsHydrostaticPressureAndTheMirroredSpeed) {
  // Fluid above the wall particle at the origin, p = 5 - rho g y, v = 2 y along the wall.
  const QuinticSpline kernel = lattice_kernel();
  const double density = 3, gravity = 2;
  WallSums<double> sums;
  double height = 0;
  around_origin(spacing, [&](const Components<2, double>& at) {
    if (at[1] > 0) {
      const PairGeometry<2, double> pair({0, 0}, at);
      const double w = kernel.value(pair.distance);
      wall_pair(sums, w, pair.r[0], pair.r[1], 0.0, 5 - density * gravity * at[1], density,
                2 * at[1], 0.0, 0.0);
      height += w * at[1];
    }
  });
  EXPECT_NEAR(wall_pressure(sums, 0, -gravity, 0), 5, 1e-12);
  const double own = 0.25, mean = 2 * height / sums.weight;
  EXPECT_NEAR(wall_velocity(own, sums.velocity_x, sums.weight), 2 * own - mean, 1e-12);
  EXPECT_EQ(wall_velocity(own, 0, 0), own);
}

TEST(CurvaturePair, FindsTheRadiusOfACircleThoughOnlyABandHasNormals) {
  const QuinticSpline kernel = lattice_kernel();
  const double radius = 10 * spacing, band = 2.5 * spacing;
  const auto side = [&](const Components<2, double>& at) {
    return std::hypot(at[0], at[1]) < radius ? 0.0 : 1.0;
  };
  const auto normal = [&](const Components<2, double>& at) {
    const double r = std::hypot(at[0], at[1]), sign = side(at) == 0 ? 1 : -1;
    return Components<2, double>{sign * at[0] / r, sign * at[1] / r};
  };
  for (const double distance : {8.0, 9.0, 10.0, 11.0, 12.0}) {
    const Components<2, double> own{distance * spacing, 0};
    CurvatureSums<2, double> sums;
    around_origin(spacing, [&](const Components<2, double>& step) {
      const Components<2, double> at{own[0] + step[0], own[1] + step[1]};
      const double near = std::abs(std::hypot(at[0], at[1]) - radius) < band ? 1 : 0;
      const PairGeometry<2, double> pair(own, at);
      curvature_pair<2, double>(sums, pair, normal(own), side(own), normal(at), side(at), near,
                                cell, pair.gradient(kernel));
    });
    Eigen::Matrix2d change, moment;
    for (std::size_t a = 0; a < 2; ++a) {
      for (std::size_t b = 0; b < 2; ++b) {
        change(static_cast<int>(a), static_cast<int>(b)) = sums.change[a][b];
        moment(static_cast<int>(a), static_cast<int>(b)) =
            sums.moment[std::min(a, b)][std::max(a, b)];
      }
    }
    const double curvature = change.cwiseProduct(moment.inverse()).sum();
    const double sign = side(own) == 0 ? 1 : -1;
    // At the rim of the band all neighbours with a normal stand on one side.
    EXPECT_NEAR(sign * curvature * own[0], 1, std::abs(distance - 10) < 1.5 ? 0.02 : 0.08)
        << distance << " spacings from the centre";
  }
}

TEST(InterfaceDepth, FindsAFlatInterfaceFromTheShareOfTheKernelBeyondIt) {
  const QuinticSpline kernel = lattice_kernel();
  const InterfaceDepth depth(kernel, 2);
  for (const double s : {0.5, 1.5}) {
    double share = 0;
    around_origin(spacing, [&](const Components<2, double>& at) {
      share += at[1] > s * spacing ? cell * kernel.value(std::hypot(at[0], at[1])) : 0;
    });
    // Rows sample the kernel at their own heights only: the second layer seems a little deeper.
    EXPECT_NEAR(depth(share), s * spacing, 0.2 * spacing);
  }
  EXPECT_EQ(depth(0.7), 0);
  EXPECT_DOUBLE_EQ(curvature_at_interface(1.0 / 8, 0.5, 2), 1 / 8.5);
  EXPECT_DOUBLE_EQ(curvature_at_interface(-2.0 / 8, 0.5, 3), -2 / 7.5);
}

TEST(GradientPair, IsExactForALinearFieldAmongScatteredNeighbours) {
  const QuinticSpline kernel = lattice_kernel();
  std::mt19937_64 random(3);
  const auto uniform = [&] { return 0.4 * static_cast<double>(random() >> 11U) * 0x1.0p-53 - 0.1; };
  GradientSums<2, double> sums;
  for (int k = 0; k < 12; ++k) {
    const Components<2, double> at{uniform(), uniform()};
    const PairGeometry<2, double> pair({0, 0}, at);
    gradient_pair<2, double>(sums, pair, 3 * at[0] - 8 * at[1], cell, pair.gradient(kernel));
  }
  Eigen::Matrix2d moment;
  moment << sums.moment[0][0], sums.moment[0][1], sums.moment[0][1], sums.moment[1][1];
  const Eigen::Vector2d slope =
      moment.inverse() * Eigen::Vector2d(sums.gradient[0], sums.gradient[1]);
  EXPECT_NEAR(slope(0), 3, 1e-11);
  EXPECT_NEAR(slope(1), -8, 1e-11);
}

TEST(ColourPair, GivesBothSidesTheSameAccelerationAndTheWholeJumpTogether) {
  // A flat interface at y = 0 between lattice rows: the sum over the rows of delta times the
  // spacing is one.
  const QuinticSpline kernel = lattice_kernel();
  const double heavy = 20, light = 1;
  double total = 0, first_heavy = 0, first_light = 0;
  for (int row = -4; row < 4; ++row) {
    const double y = (row + 0.5) * spacing, side = row < 0 ? 0 : 1;
    const double density = row < 0 ? heavy : light;
    double gradient = 0;
    around_origin(spacing, [&](const Components<2, double>& step) {
      const double other = y + step[1] < 0 ? 0 : 1;
      const PairGeometry<2, double> pair({0, 0}, step);
      gradient += colour_pair(cell, density, side, cell, other == 0 ? heavy : light, other,
                              pair.gradient(kernel)) *
                  pair.r[1] / cell;
    });
    EXPECT_GE(gradient * (row < 0 ? 1 : -1), 0) << "points out of its own side, row " << row;
    total += std::abs(gradient) * spacing;
    first_heavy = row == -1 ? gradient / density : first_heavy;
    first_light = row == 0 ? -gradient / density : first_light;
  }
  EXPECT_NEAR(total, 1, 0.002);
  EXPECT_NEAR(first_heavy, first_light, 1e-12 * first_heavy);
}

}  // namespace meltproof::solver

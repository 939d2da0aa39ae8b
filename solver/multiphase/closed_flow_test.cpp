// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/multiphase/closed_flow.hpp"

#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <omp.h>

#include "base/error.hpp"
#include "solver/verification/flow_exact.hpp"
#include "solver/verification/flow_problems.hpp"
#include "solver/verification/flow_setup.hpp"

namespace meltproof::solver {
namespace {

/// A periodic box of two fluids with random speeds; the lighter one fills the middle.
ClosedFlow shaken_box(int dimensions, std::size_t cells, bool interface) {
  const double spacing = 1.0 / static_cast<double>(cells);
  ClosedFlowModel model;
  model.fluids = {{1, 0.02, 0, 1}, {0.2, 0.01, 0, 1}};
  model.stiffness = model.background = 100;
  model.interface = interface;
  const Vector upper{1, 1, dimensions == 3 ? 1.0 : 0.0};
  model.domain =
      box({0, 0, 0}, upper,
          {Face::periodic, Face::periodic, dimensions == 3 ? Face::periodic : Face::open});
  std::mt19937_64 random(7);
  const auto uniform = [&] { return 2 * static_cast<double>(random() >> 11U) * 0x1.0p-53 - 1; };
  auto start =
      fill_lattice(dimensions, spacing, {0, 0, 0}, upper, model.fluids, [&](const Vector& at) {
        const double r = std::hypot(at[0] - 0.5, at[1] - 0.5);
        return r < 0.3 ? Placement{Phase::gas, 1, {}} : Placement{Phase::liquid, 0, {}};
      });
  for (std::size_t i = 0; i < start.particles.size(); ++i) {
    for (std::size_t d = 0; d < static_cast<std::size_t>(dimensions); ++d) {
      start.particles.position[i][d] += 0.1 * spacing * uniform();
      start.particles.velocity[i][d] = uniform();
    }
  }
  ClosedFlow flow(std::move(start.particles), std::move(start.fluid), model);
  for (double& tension : flow.fields().tension) {
    tension = 0.1;
  }
  flow.evaluate();
  return flow;
}

Vector momentum(const ClosedFlow& flow) {
  Vector sum{};
  for (std::size_t i = 0; i < flow.particles().size(); ++i) {
    for (std::size_t d = 0; d < 3; ++d) {
      sum[d] += flow.particles().mass[i] * flow.particles().velocity[i][d];
    }
  }
  return sum;
}

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

TEST(ClosedFlow, KeepsMomentumInAPeriodicBox) {
  for (const int dimensions : {2, 3}) {
    ClosedFlow flow = shaken_box(dimensions, dimensions == 2 ? 20 : 8, false);
    const Vector before = momentum(flow);
    for (int k = 0; k < 30; ++k) {
      flow.advance(flow.stable_step());
    }
    EXPECT_GT(flow.builds(), 1U) << "the lists were to be remade on the way";
    const Vector after = momentum(flow);
    for (std::size_t d = 0; d < 3; ++d) {
      EXPECT_NEAR(after[d], before[d], 1e-13) << dimensions << " dimensions, axis " << d;
    }
  }
}

TEST(ClosedFlow, GivesTheSameBytesOnAnyNumberOfThreads) {
  std::vector<Vector> velocity;
  for (const int threads : {1, 2}) {
    omp_set_num_threads(threads);
    ClosedFlow flow = shaken_box(2, 48, true);
    for (int k = 0; k < 12; ++k) {
      flow.advance(flow.stable_step());
    }
    if (threads == 1) {
      velocity = flow.particles().velocity;
    } else {
      EXPECT_EQ(flow.particles().velocity, velocity);
    }
  }
}

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

TEST(ClosedFlow, HoldsASmallHydrostaticColumn) {
  VerificationCase c;
  c.name = "small column";
  c.density = 1;
  c.density_ratio = 4;
  c.reynolds = 10;
  c.height = 1;
  c.width = 0.3;
  c.gravity = 1;
  c.time = 2;
  c.steps = 500;
  const VerificationRun run = run_hydrostatic(c, 0.1);
  EXPECT_LT(run.error, 0.03);
  EXPECT_TRUE(run.broken.empty());
}

TEST(ClosedFlow, SlidesCouetteFlowAlongAMovingWall) {
  VerificationCase c;
  c.name = "small Couette";
  c.variant = "couette";
  c.density = c.speed = 1;
  c.reynolds = 1;
  c.height = 1;
  c.width = 0.4;
  c.time = 1;
  EXPECT_LT(run_channel(c, 0.1).error, 0.02);
}

TEST(ClosedFlow, RefusesAFluidThatIsNotThereAndNamesTheParticleThatBlewUp) {
  ClosedFlow flow = shaken_box(2, 10, false);
  auto fluid = flow.fields().fluid;
  fluid[3] = 5;
  EXPECT_THROW(ClosedFlow(flow.particles(), fluid, flow.model()), InputError);
  flow.particles().velocity[3][0] = std::nan("");
  const std::string name = std::to_string(flow.particles().identity[3]);
  try {
    flow.advance(1e-4);
    FAIL() << "a velocity that is no number was not noticed";
  } catch (const std::runtime_error& stopped) {
    EXPECT_NE(std::string(stopped.what()).find("particle " + name), std::string::npos)
        << stopped.what();
  }
}

TEST(FlowExact, HoldsTheConditionsThatDefineEachSolution) {
  const ShearFlow couette({{1, 2, 0}}, 3);
  EXPECT_NEAR(couette(0.25), 0.75, 1e-14);
  const ShearFlow parabola({{0.5, 1, 8}, {0.5, 1, 8}}, 0);
  EXPECT_NEAR(parabola(0.5), 1, 1e-14);
  EXPECT_NEAR(parabola(0.25), 0.75, 1e-14);
  const ShearFlow two({{0.5, 4, 8}, {0.5, 1, 8}}, 0);
  const double e = 1e-6;
  EXPECT_NEAR(two(1), 0, 1e-14);
  EXPECT_NEAR(4 * (two(0.5) - two(0.5 - e)) / e, (two(0.5 + e) - two(0.5)) / e, 1e-4);
  EXPECT_NEAR(std::exp(taylor_green_rate(100)), 0.454041, 1e-6);
  EXPECT_NEAR(migration_speed(-1, 1, 1, 1, 1, 1, 1), 2.0 / 15, 1e-15);
  const CavityReference table = cavity_reference(1000);
  EXPECT_EQ(table.u.size(), table.y.size());
  EXPECT_EQ(table.v.size(), table.x.size());
  EXPECT_THROW(cavity_reference(400), InputError);
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/multiphase/closed_flow.hpp"

#include <cmath>
#include <optional>
#include <random>

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
  const int before = omp_get_max_threads();
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
  omp_set_num_threads(before);
}

// What lies behind a periodic face must reach a wall as what lies in front of it does, in the very
// evaluation in which the lists are made too.
TEST(ClosedFlow, AWallIsTheSameAllAlongAPeriodicBox) {
  ClosedFlowModel model;
  model.fluids = {{1, 0.1, 0, 1}};
  model.stiffness = model.background = 100;
  model.added_pressure = 10;
  model.domain = box({0, -0.3, 0}, {1, 1, 0}, {Face::periodic, Face::open, Face::open});
  auto start = fill_lattice(2, 0.1, {0, -0.3, 0}, {1, 1, 0}, model.fluids, [](const Vector& at) {
    return at[1] < 0 ? Placement{Phase::solid, -1, {}} : Placement{Phase::liquid, 0, {}};
  });
  ClosedFlow flow(std::move(start.particles), std::move(start.fluid), model);
  for (std::size_t i = 0; i < flow.particles().size(); ++i) {
    if (flow.particles().phase[i] == Phase::liquid) {
      flow.particles().velocity[i] = {1, 0, 0};
    }
  }
  flow.evaluate();
  std::optional<double> drag;
  for (std::size_t i = 0; i < flow.particles().size(); ++i) {
    const double height = flow.particles().position[i][1];
    if (std::abs(height) < 0.1) {
      EXPECT_NEAR(flow.pressure()[i], 10, 0.05) << flow.particles().position[i][0];
    }
    if (height > 0 && height < 0.1) {
      drag = drag.value_or(flow.acceleration()[i][0]);
      EXPECT_NEAR(flow.acceleration()[i][0], *drag, 1e-9) << flow.particles().position[i][0];
      EXPECT_LT(*drag, -1);
    }
  }
}

TEST(ClosedFlow, ContinuedDensityFollowsCompressionAndGoesToTheSum) {
  const double pi = 3.14159265358979, speed = 1e-3, step = 1e-6;
  for (const double relaxation : {1e12, 30.0}) {
    ClosedFlowModel model;
    model.fluids = {{1, 0.1, 0, 1}};
    model.stiffness = model.background = 100;
    model.density_relaxation = relaxation;
    model.density_diffusion = 0;
    model.domain = box({0, 0, 0}, {1, 1, 0}, {Face::periodic, Face::periodic, Face::open});
    auto start = fill_lattice(2, 0.02, {0, 0, 0}, {1, 1, 0}, model.fluids,
                              [](const Vector&) { return Placement{}; });
    ClosedFlow flow(std::move(start.particles), std::move(start.fluid), model);
    Particles& particles = flow.particles();
    const double summed = particles.density[0], off = 1.01 * summed;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      particles.velocity[i][0] = speed * std::sin(2 * pi * particles.position[i][0]);
      particles.density[i] = off;
    }
    flow.advance(step);
    // c = 10, h = 0.02: the excess falls at c/(N h).
    const double excess = (off - summed) * (1 - step * 10 / (relaxation * 0.02));
    for (std::size_t i = 0; i < particles.size(); i += 37) {
      const double compression =
          -off * speed * 2 * pi * std::cos(2 * pi * particles.position[i][0]);
      EXPECT_NEAR((particles.density[i] - summed - excess) / step, compression,
                  0.02 * speed * 2 * pi);
    }
  }
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

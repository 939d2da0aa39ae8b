// SPDX-License-Identifier: GPL-3.0-or-later
// How the flow cases are filled with particles, run and read.
#pragma once

#include <array>
#include <functional>

#include "solver/multiphase/closed_flow.hpp"
#include "solver/verification/case.hpp"

namespace meltproof::solver {

/// What stands at a place of the starting lattice.
struct Placement {
  Phase phase = Phase::liquid;  ///< Phase::solid is wall
  std::int32_t fluid = 0;       ///< into the model's fluids; of a wall: -1
  Vector velocity{};            ///< m s-1
};

/// Particles and which fluid each is of.
struct FlowStart {
  Particles particles;
  std::vector<std::int32_t> fluid;
};

/// A square or cubic lattice whose cells fill the box; particles stand in the middle of their
/// cells. The box must be a whole number of spacings wide. In two dimensions z is 0.
FlowStart fill_lattice(int dimensions, double spacing, const Vector& lower, const Vector& upper,
                       const std::vector<Fluid>& fluids,
                       const std::function<Placement(const Vector&)>& place);

/// A fluid's stiffness p0 = rho c^2, and `background` times it as p_b of the transport velocity.
void set_stiffness(ClosedFlowModel& model, double density, double sound_speed, double background);

/// A run whose profile shows `value` over `position`, each a name and its SI unit.
VerificationRun start_run(const ClosedFlow& flow, const std::array<const char*, 2>& position,
                          const std::array<const char*, 2>& value);

/// Appends one point to the profile.
void show(VerificationRun& run, double position, double value, double exact);

/// A box whose faces along each axis are the given ones.
Domain box(const Vector& lower, const Vector& upper, const std::array<Face, 3>& face);

/// Steps of the largest stable length until `time`; the last one ends there.
void run_until(ClosedFlow& flow, double time);

/// Shakes every fluid particle by up to `amplitude` spacings, then lets them come to rest as the
/// pressure and the background pressure drive them, speed taken away after each of `steps` steps.
/// An arrangement with neither order nor clumps, as a running flow has it. The same every time.
void relax(ClosedFlow& flow, double amplitude, std::size_t steps);

/// Value and gradient-free reading of a field at a place: moving least squares with a linear basis
/// over the fluid particles in the kernel's support. @throws std::logic_error if too few are there.
double read_at(const ClosedFlow& flow, const Vector& at,
               const std::function<double(std::size_t)>& value);

/// Largest speed of a fluid particle, m s-1.
double largest_speed(const ClosedFlow& flow);

/// Smallest distance to a neighbour, in spacings: its least over the fluid particles, and the share
/// of them below 0.5.
struct Clumping {
  double nearest = 0, share_below_half = 0;
};
Clumping clumping(const ClosedFlow& flow);

}  // namespace meltproof::solver

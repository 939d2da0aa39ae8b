// SPDX-License-Identifier: GPL-3.0-or-later
// What an engine must be given to go on as if it had never stopped.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "solver/flow/free_surface.hpp"
#include "solver/particles/particles.hpp"
#include "solver/step/time_step.hpp"

namespace meltproof::solver {

/// Wall-clock seconds spent in each part of the step since the start.
struct StepTimes {
  double heat = 0, species = 0, surface = 0, state = 0, lists = 0, flow = 0;
};

/// Energies since the start, J.
struct EnergyLedger {
  double absorbed = 0, reflected = 0, missed = 0;      ///< of the laser's
  double evaporated = 0, radiated = 0, convected = 0;  ///< lost through the surface
  double evaporated_mass = 0;  ///< kg that the vapour would carry; the particles keep it
};

/// The particles of this rank's engine as part of its state, looked at where they are: a state of
/// its own would take a third of the engine's memory once more. What is said of entry i holds for
/// those of `own`.
struct StateView {
  const Particles& particles;
  std::vector<std::uint32_t> own;  ///< entries of the particles that this rank computes
  const std::vector<std::uint8_t>&mobile, &pace;  ///< as in EngineState
  const std::vector<double>& slow_power;          ///< likewise
  std::function<Vector(std::uint32_t)> listed_at;
  std::function<FlowParticle(std::uint32_t)> flow;  ///< of a liquid one; none without flow
};

/// The state between two steps. Everything else an engine holds follows from it: the lists from the
/// places at which they were last made, in the order of the particles, which is part of the state
/// because sums follow it.
struct EngineState {
  Particles particles;
  std::vector<Vector> listed_at;     ///< m, places of the particles when the lists were made
  std::vector<std::uint8_t> mobile;  ///< 1 for those that counted as moving then
  std::vector<double> slow_power;    ///< W m-3, of the round of heat steps under way
  std::vector<std::uint8_t> pace;    ///< how often each exchanges heat in it, see namespace pace
  double round_time = 0;             ///< s, so far; zero: none is under way
  FlowMemory flow;  ///< of the last evaluation of the forces, of each liquid particle in the order
                    ///< of `particles`; empty without flow
  LimiterCounts limiters;        ///< so far
  EnergyLedger ledger;           ///< so far
  StepLimits limits;             ///< of the last step
  StepTimes times;               ///< so far
  double time = 0;               ///< s
  double start_temperature = 0;  ///< K, of a domain that begins at one temperature
  std::size_t steps = 0, flow_steps = 0, list_builds = 0, builds_since_sort = 0, lost = 0;
};

}  // namespace meltproof::solver

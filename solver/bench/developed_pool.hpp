// SPDX-License-Identifier: GPL-3.0-or-later
// The state from which whole steps are timed: a track whose melt pool has developed.
#pragma once

#include "solver/bench/figure.hpp"
#include "solver/case/track_case.hpp"
#include "solver/step/engine.hpp"

namespace meltproof::solver {

/// What every stage begins from. An engine of the same model goes on from `state`.
struct DevelopedPool {
  Mixture mixture;
  Diffusivity diffusivity;
  Model model;                       ///< as tracks run
  EngineState state;                 ///< at the time that was asked for
  Figure memory;                     ///< bytes_per_particle, measured while the pool developed
  double seconds = 0;                ///< of wall-clock time that it took to develop
  std::size_t liquid = 0, wall = 0;  ///< particles that flow, and those that bound the flow
  double neighbours = 0;             ///< mean length of a neighbour list
  double list_bytes = 0;             ///< held by the neighbour lists' indices, per particle
};

/// Simulates the track until `until` (s), on one thread, with progress on standard error.
/// To be called before the program has held much memory: what it held at its peak counts.
/// @throws InputError if the case cannot be discretised, has no flow with a free surface, or no
/// melt by then.
DevelopedPool develop_pool(const TrackCase& track, double until);

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// States put in order and shared out among ranks, for an engine that goes on from one.
#pragma once

#include <vector>

#include "solver/parallel/decomposition.hpp"
#include "solver/step/engine_state.hpp"
#include "solver/step/traveller.hpp"

namespace meltproof::solver {

/// Appends what a flow remembers of a liquid particle.
void remember(FlowMemory& memory, const FlowParticle& particle);

/// Puts a state in the engine's order, which sums follow.
EngineState& in_order(EngineState& state);

/// Sends the particles of a part of a state to their owners, and to those that keep copies of them.
/// Whose a particle is follows from where it was when the lists were made. A little at a time, so
/// that what is under way needs no memory to speak of.
/// @returns what belongs to this rank or is copied here, in the engine's order; Traveller::rank is
/// the owner.
std::vector<Traveller> share_out(const EngineState& state, const Particles& p, const Ranks& ranks,
                                 const Decomposition& decomposition, double reach);

}  // namespace meltproof::solver

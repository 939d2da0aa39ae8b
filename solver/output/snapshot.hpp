// SPDX-License-Identifier: GPL-3.0-or-later
// The fields of a run as data sets of an artifact.
#pragma once

#include <string>

#include "base/artifact.hpp"
#include "solver/step/engine.hpp"

namespace meltproof::solver {

/// Writes the particles of the present moment into the group snapshots/<number, four digits>,
/// ordered by identity, so that a snapshot does not depend on how the engine keeps its particles.
void write_snapshot(ArtifactWriter& writer, std::size_t number, const Engine& engine);

}  // namespace meltproof::solver

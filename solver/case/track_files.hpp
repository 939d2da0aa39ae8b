// SPDX-License-Identifier: GPL-3.0-or-later
// The files that a whole run leaves.
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "base/provenance.hpp"
#include "solver/case/track_case.hpp"
#include "solver/output/checkpoint.hpp"
#include "solver/step/engine.hpp"

namespace meltproof::solver {

/// Puts run.h5 together from the snapshots, and writes run.xdmf, history.csv, input.toml and
/// result.json, each only when whole. The root does it, all ranks wait. Collective.
/// @throws std::runtime_error with a sentence on all ranks if the disk is full.
void write_track_files(const std::filesystem::path& folder, const TrackCase& track,
                       const Engine& engine, const Discretisation& made,
                       const CheckpointFolder& checkpoints, const RunProgress& run,
                       const Provenance& provenance, const nlohmann::json& result);

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// A whole track: from case to run.h5, history.csv and result.json.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "base/provenance.hpp"
#include "solver/case/track_case.hpp"
#include "solver/parallel/ranks.hpp"

namespace meltproof::solver {

/// How a run is carried out; none of it changes what comes out.
struct RunOptions {
  std::string name;  ///< of the case, for progress and result.json
  std::filesystem::path
      folder;  ///< for run.h5, history.csv, result.json and, meanwhile, checkpoints
  bool quiet = false;
  bool restart = false;              ///< go on from the newest checkpoint, if there is one
  double checkpoint_interval = 600;  ///< s of wall-clock time between two; zero: none
  std::size_t checkpoint_steps = 0;  ///< thermal steps between two; zero: none
  std::filesystem::path melt_of;     ///< history.csv of a coarser run, for the time left; or empty
  Ranks ranks;                       ///< that share the run; the root writes what there is to write
};

/// Runs the track and writes run.h5, history.csv and result.json into the folder, each only when
/// whole, and checkpoints on the way. Collective. @returns what result.json holds, on the root.
/// @throws Stopped after SIGTERM or SIGINT, with a checkpoint written.
/// @throws std::runtime_error naming particle, term and last good checkpoint if a number is none.
nlohmann::json run_track(const TrackCase& track, const RunOptions& options, Provenance provenance);

}  // namespace meltproof::solver

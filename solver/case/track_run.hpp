// SPDX-License-Identifier: GPL-3.0-or-later
// A whole track: from case to run.h5, history.csv and result.json.
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "base/provenance.hpp"
#include "solver/case/track_case.hpp"

namespace meltproof::solver {

/// Runs the track and writes run.h5, history.csv and result.json into `folder`, each only when
/// whole.
/// @param name of the case, for result.json; @returns what result.json holds.
nlohmann::json run_track(const TrackCase& track, const std::string& name,
                         const std::filesystem::path& folder, Provenance provenance, bool quiet);

}  // namespace meltproof::solver

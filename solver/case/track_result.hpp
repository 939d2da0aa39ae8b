// SPDX-License-Identifier: GPL-3.0-or-later
// What result.json says of a track.
#pragma once

#include <nlohmann/json.hpp>

#include "solver/case/track_case.hpp"
#include "solver/output/checkpoint.hpp"
#include "solver/output/run_summary.hpp"

namespace meltproof::solver {

/// The isotherm that outlines the melt pool, K: the case's, or the liquidus of the base material.
double pool_isotherm(const TrackCase& track, const Mixture& mixture);

/// Mean clumped share of the melt (1) over the window in which the pool's sizes are averaged.
double clumped_in_window(const TrackCase& track, const std::vector<HistoryLine>& lines);

/// Whether any melt still lies on solid metal, on whatever rank (collective); a drop in flight has
/// nothing to freeze to.
bool melt_left(const Engine& engine);

/// Where the parts of a run's time went, s.
Timings step_timings(const Engine& engine);

/// What a complete run has found: sizes as means over the window at the end of the exposure,
/// balances, steadiness, limiters, acceptance. Units are in the keys.
/// Collective; what the root returns counts. @param run with all lines of its history; @param whole
/// the particles of all ranks.
nlohmann::json track_result(const TrackCase& track, const Discretisation& made,
                            const Engine& engine, const RunProgress& run, const Particles& whole,
                            const Acceptance& acceptance);

}  // namespace meltproof::solver

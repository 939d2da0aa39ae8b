// SPDX-License-Identifier: GPL-3.0-or-later
// What stands at the end of a run: where a track is judged, and the log for a reader.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/provenance.hpp"
#include "solver/output/acceptance.hpp"

namespace meltproof::solver {

/// Length of a track's start that is left out of every mean, m: 130 um, where a pool starts from
/// cold and leaves pits, but never more than 0.4 of the track.
double start_up_length(double track_length);

/// Where the solidified track is judged: from the end of its start to 0.8 of its length, beyond
/// which the last pool froze without the beam; over one beam radius across.
/// @param lower, upper of the domain, m; @param track_length the beam's way, m.
AcceptanceSettings track_acceptance(const Vector& lower, const Vector& upper, double track_length,
                                    double beam_radius);

/// Seconds of wall-clock time by part of the program, in the order to be shown.
using Timings = std::vector<std::pair<std::string, double>>;

/// The timings as an object "part_s": seconds.
nlohmann::json timings_json(const Timings& timings);

/// Where the time went so far, on one line; parts below a thousandth are left out.
std::string time_line(const Timings& timings, const Provenance& provenance, std::size_t steps);

/// The last words of a run: pool and steadiness, what is conserved, the acceptance table, where the
/// time went (parts below a thousandth are left out), versions, and the files with the resolved
/// input. @param result as in result.json.
std::string run_summary(const nlohmann::json& result, const Acceptance& acceptance,
                        const Timings& timings, const Provenance& provenance,
                        const std::filesystem::path& folder);

/// Prints run_summary() on standard output.
void print_run_summary(const nlohmann::json& result, const Acceptance& acceptance,
                       const Timings& timings, const Provenance& provenance,
                       const std::filesystem::path& folder);

}  // namespace meltproof::solver

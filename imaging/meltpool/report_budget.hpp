// SPDX-License-Identifier: GPL-3.0-or-later
// The uncertainty budget and the reference signal in summary.json and for a person.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "imaging/meltpool/measurement.hpp"

namespace meltproof::imaging {

/// Whether S* was found and used, its value with its uncertainty, and the emissivity it implies.
nlohmann::json reference_json(const Measurement& measurement, const RecordingHeader& header);

/// What would narrow an interval that an emissivity widens, one sentence; empty where the level
/// rests on none.
std::string would_narrow(const Measurement& measurement);

/// A line that warns of a reference signal that is used although it is vague, or an empty text.
std::string caution(const Measurement& measurement);

/// Corrected length and depth with their intervals, and one row for every input.
nlohmann::json budget_json(const Budget& budget, const Analysis& analysis);

/// The same as lines of text.
std::string budget_text(const Budget& budget, const Analysis& analysis);

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// What an uncertain input of a track does to length, width and depth of its pool.
#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "validation/studies/declaration.hpp"

namespace meltproof::validation {

/// A finished run of a series, as it is declared and with its result.
struct FinishedRun {
  const StudyRun* declared = nullptr;
  nlohmann::json result = {};
};

/// A run whose melt clumps by this share or more does not count.
constexpr double clumped_allowed = 0.01;

/// {value, unit, relative_uncertainty, ...} of a series of kind input; of a choice both are null.
/// @throws InputError if value or uncertainty are no quantities of one dimension.
nlohmann::json input_facts(const StudySeries& series);

/// Of one quantity ("length", ...): `changes` of each run against the base, `relative_sensitivity`
/// (null for a choice), `relative_u` of the base (null if every run but the base is left out),
/// `one_sided`, `same_side`, `left_out` (runs whose melt clumps).
/// @throws InputError if a result lacks a number, or a run's setting is no quantity like the value.
nlohmann::json input_effect(const StudySeries& series, const std::vector<FinishedRun>& runs,
                            const std::string& quantity);

/// The number at `key` of the result of a run. @throws InputError if there is none.
double result_number(const nlohmann::json& result, const std::string& key, const std::string& run);

}  // namespace meltproof::validation

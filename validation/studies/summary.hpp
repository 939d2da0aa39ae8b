// SPDX-License-Identifier: GPL-3.0-or-later
// What the studies say of the uncertainty of a pool: by its numerics and by its inputs.
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "validation/studies/declaration.hpp"

namespace meltproof::validation {

/// Length, width and depth over all series, from <folder>/<run>.json of each run.
///
/// `series`: of each its runs with values, what is missing, and by quantity: of a resolution what
/// resolution_series() finds; of the others the spread, half of the range over sqrt(3), of the runs
/// whose melt does not clump (less than 1 % below half a spacing); a run that clumps is `left_out`.
/// `quantities`: by quantity the `relative_u` of the base, sums of squares over the counted series
/// of kind resolution and numerical, with its parts; null as long as no such series is complete.
/// @throws InputError if a result is there but damaged.
nlohmann::json summarise(const StudyDeclaration& studies, const std::filesystem::path& folder);

}  // namespace meltproof::validation

// SPDX-License-Identifier: GPL-3.0-or-later
// What the rows of the table can compute. A new one: a function here and one line in metric.cpp.
#pragma once

#include <string>
#include <vector>

#include "validation/compare/result.hpp"
#include "validation/compare/sources.hpp"
#include "validation/compare/table.hpp"

namespace meltproof::validation {

/// Names that a row's `metric` may take:
/// - difference: S and D are one number each; V&V 20.
/// - error_norm: S is the size of an error, of a verification case or of a balance; no reference.
/// - number: S is a number as it is; no reference.
/// - curve: S is the RMSE of a line scan against a measured curve, from linescan.json.
/// - trend: S is the smallest rise along the settings that the reference ranks.
std::vector<std::string> metric_names();

/// Computes the numbers of a row. @throws InputError if something that it needs is missing.
RowNumbers compute(const Row& row, const Places& places);

}  // namespace meltproof::validation

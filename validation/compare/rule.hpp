// SPDX-License-Identifier: GPL-3.0-or-later
// When a row agrees. A new rule: a function and one line in rule.cpp.
#pragma once

#include <string>
#include <vector>

#include "validation/compare/result.hpp"
#include "validation/compare/table.hpp"

namespace meltproof::validation {

/// Names that a row's `rule` may take:
/// - within_uncertainty: |E| <= k u_val. - at_most: S <= limit. - at_least: S >= limit.
/// - rises: every step of the trend rises by more than k times its uncertainty.
std::vector<std::string> rule_names();

/// Whether the numbers obey the row's rule. @throws InputError if a number that it needs is absent.
bool obeys(const Row& row, const RowNumbers& numbers);

/// The rule with its numbers, for the report: "|E| <= 2 u_val".
std::string rule_text(const Row& row);

}  // namespace meltproof::validation

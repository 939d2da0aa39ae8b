// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a quantity rises along a given order of settings, with regard to its uncertainty.
#pragma once

#include <span>
#include <vector>

namespace meltproof::validation {

/// One step from a setting to the next.
struct TrendStep {
  double rise = 0;         ///< value after minus value before
  double uncertainty = 0;  ///< sqrt of the sum of both squared standard uncertainties
  double confidence = 0;   ///< probability that the true rise is positive, for normal errors
};

enum class TrendResult {
  rises,      ///< every step rises by more than k times its uncertainty
  undecided,  ///< some step is within its uncertainty, none falls beyond it
  falls,      ///< some step falls by more than k times its uncertainty
};

struct Trend {
  std::vector<TrendStep> steps;
  TrendResult result = TrendResult::undecided;
  std::size_t weakest = 0;  ///< the step with the smallest rise
};

/// @param values in the order of the settings, at least two
/// @param uncertainties standard uncertainties, one per value, or empty for none
/// @param coverage k. @throws InputError for fewer than two values or another number of
/// uncertainties.
Trend trend(std::span<const double> values, std::span<const double> uncertainties, double coverage);

}  // namespace meltproof::validation

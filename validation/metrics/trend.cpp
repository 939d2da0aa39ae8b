// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/metrics/trend.hpp"

#include <cmath>

#include <fmt/format.h>
#include <gsl/gsl_cdf.h>

#include "base/error.hpp"

namespace meltproof::validation {

Trend trend(std::span<const double> values, std::span<const double> uncertainties,
            double coverage) {
  if (values.size() < 2 || (!uncertainties.empty() && uncertainties.size() != values.size())) {
    throw InputError(fmt::format(
        "a trend of {} values with {} uncertainties cannot be tested: expected at least two values "
        "and as many uncertainties, or none.",
        values.size(), uncertainties.size()));
  }
  Trend result;
  bool all_rise = true, one_falls = false;
  for (std::size_t i = 0; i + 1 < values.size(); ++i) {
    TrendStep step;
    step.rise = values[i + 1] - values[i];
    if (!uncertainties.empty()) {
      step.uncertainty = std::hypot(uncertainties[i], uncertainties[i + 1]);
    }
    step.confidence = step.uncertainty > 0 ? gsl_cdf_ugaussian_P(step.rise / step.uncertainty)
                                           : (step.rise > 0   ? 1.0
                                              : step.rise < 0 ? 0.0
                                                              : 0.5);
    all_rise = all_rise && step.rise > coverage * step.uncertainty;
    one_falls = one_falls || step.rise < -coverage * step.uncertainty;
    result.steps.push_back(step);
    if (step.rise < result.steps[result.weakest].rise) {
      result.weakest = i;
    }
  }
  result.result = all_rise    ? TrendResult::rises
                  : one_falls ? TrendResult::falls
                              : TrendResult::undecided;
  return result;
}

}  // namespace meltproof::validation

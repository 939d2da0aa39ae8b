// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/metrics/validation_error.hpp"

#include <cmath>

namespace meltproof::validation {

ValidationError validation_error(double simulated, double measured,
                                 const ComparisonUncertainty& uncertainty, double coverage) {
  const double n = uncertainty.numerical.value_or(0);
  const double i = uncertainty.input.value_or(0);
  const double d = uncertainty.data.value_or(0);
  ValidationError result;
  result.error = simulated - measured;
  result.uncertainty = std::sqrt(n * n + i * i + d * d);
  result.lower = result.error - coverage * result.uncertainty;
  result.upper = result.error + coverage * result.uncertainty;
  result.complete = uncertainty.numerical && uncertainty.input && uncertainty.data;
  return result;
}

}  // namespace meltproof::validation

// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/metrics/curve.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gsl/gsl_statistics_double.h>

#include "base/error.hpp"

namespace meltproof::validation {

CurveMetrics curve_metrics(std::span<const double> simulated, std::span<const double> measured,
                           std::span<const double> uncertainty, std::size_t fitted) {
  const std::size_t n = measured.size();
  if (simulated.size() != n || n == 0 || (!uncertainty.empty() && uncertainty.size() != n)) {
    throw InputError(fmt::format(
        "curves of {} simulated and {} measured points with {} uncertainties cannot be compared: "
        "expected equal numbers, at least one.",
        simulated.size(), n, uncertainty.size()));
  }
  CurveMetrics result;
  result.points = n;
  double squares = 0, chi = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double difference = simulated[i] - measured[i];
    result.bias += difference;
    result.mean_absolute += std::abs(difference);
    result.maximum_deviation = std::max(result.maximum_deviation, std::abs(difference));
    squares += difference * difference;
    if (!uncertainty.empty()) {
      if (!(uncertainty[i] > 0)) {
        throw InputError(fmt::format(
            "the uncertainty of point {} is {}: expected a positive number.", i, uncertainty[i]));
      }
      chi += std::pow(difference / uncertainty[i], 2);
    }
  }
  const auto count = static_cast<double>(n);
  result.bias /= count;
  result.mean_absolute /= count;
  result.root_mean_square = std::sqrt(squares / count);
  const double spread = gsl_stats_tss(measured.data(), 1, n);
  if (spread > 0) {
    result.r_squared = 1 - squares / spread;
  }
  if (!uncertainty.empty() && n > fitted) {
    result.reduced_chi_square = chi / static_cast<double>(n - fitted);
  }
  return result;
}

}  // namespace meltproof::validation

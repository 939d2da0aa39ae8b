// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/metrics/log_ratio.hpp"

#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <gsl/gsl_statistics_double.h>

#include "base/error.hpp"

namespace meltproof::validation {

LogRatio log_ratio(std::span<const RatioDatum> data) {
  if (data.size() < 2) {
    throw InputError(fmt::format(
        "bias and scatter of {} comparison cannot be told: expected at least two.", data.size()));
  }
  std::vector<double> logarithms;
  double squares = 0;
  for (const auto& datum : data) {
    if (!(datum.simulated > 0 && datum.measured > 0)) {
      throw InputError(
          fmt::format("the ratio of {} to {} has no logarithm: expected positive numbers.",
                      datum.simulated, datum.measured));
    }
    logarithms.push_back(std::log(datum.simulated / datum.measured));
    squares += datum.relative_uncertainty * datum.relative_uncertainty;
  }
  LogRatio result;
  result.points = data.size();
  const double mean = gsl_stats_mean(logarithms.data(), 1, logarithms.size());
  const double variance = gsl_stats_variance_m(logarithms.data(), 1, logarithms.size(), mean);
  const double measured = squares / static_cast<double>(data.size());
  const double model = std::max(0.0, variance - measured);
  result.scatter_is_noise = variance <= measured;
  result.measured_scatter = std::sqrt(measured);
  result.model_scatter = std::sqrt(model);
  result.bias = std::exp(mean + 0.5 * (model - measured));
  return result;
}

}  // namespace meltproof::validation

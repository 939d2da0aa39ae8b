// SPDX-License-Identifier: GPL-3.0-or-later
// What a growing series tends to.
#pragma once

#include <vector>

namespace meltproof::solver {

/// **L(t) = L_inf (1 - exp(-t / tau))** fitted by least squares (Levenberg-Marquardt).
struct SaturationFit {
  bool found = false;
  double limit = 0, u_limit = 0;  ///< L_inf and its standard uncertainty, in the series' unit
  double tau = 0, u_tau = 0;      ///< s
  double residual = 0;            ///< standard deviation of the residuals, in the series' unit
  double effective = 0;           ///< independent values among the residuals
};

/// Fits the series value[i] at time[i] > 0, s. The covariance is that of independent residuals,
/// with their effective number in place of their number.
SaturationFit fit_saturation(const std::vector<double>& time, const std::vector<double>& value);

}  // namespace meltproof::solver

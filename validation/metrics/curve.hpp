// SPDX-License-Identifier: GPL-3.0-or-later
// How far a simulated curve lies from a measured one.
#pragma once

#include <optional>
#include <span>

namespace meltproof::validation {

/// Differences are simulated minus measured, in the unit of the values.
struct CurveMetrics {
  std::size_t points = 0;
  double bias = 0;                  ///< mean difference
  double mean_absolute = 0;         ///< MAE
  double root_mean_square = 0;      ///< RMSE
  double maximum_deviation = 0;     ///< largest absolute difference
  std::optional<double> r_squared;  ///< 1 - sum (S-D)^2 / sum (D - mean D)^2; absent for a flat D
  /// sum ((S-D)/u)^2 / (points - fitted); absent without uncertainties or degrees of freedom
  std::optional<double> reduced_chi_square;
};

/// @param simulated,measured values at the same places, at least one
/// @param uncertainty standard uncertainty of each difference; empty if unknown
/// @param fitted number of parameters that were fitted to these points
/// @throws InputError if the lengths differ, there is no point, or an uncertainty is not positive.
CurveMetrics curve_metrics(std::span<const double> simulated, std::span<const double> measured,
                           std::span<const double> uncertainty = {}, std::size_t fitted = 0);

}  // namespace meltproof::validation

// SPDX-License-Identifier: GPL-3.0-or-later
// Mean and spread of a measured series whose neighbours resemble each other.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace meltproof::imaging {

struct Series {
  std::size_t n = 0;
  double mean = 0;
  double deviation = 0;  ///< standard deviation of one value; 0 for fewer than two values
  /// Number of independent values with the same standard deviation of the mean,
  /// n / (1 + 2 sum rho_k), summed over the lags until the autocorrelation rho_k first vanishes.
  double effective = 0;
  /// Mann-Kendall statistic with ties: beyond +-1.96 the series rises or falls (5 % level).
  double trend = 0;
  bool steady() const { return trend > -1.96 && trend < 1.96; }
  /// deviation / sqrt(effective); 0 for fewer than two values.
  double uncertainty_of_mean() const;
};

Series summarise(std::span<const double> values);

/// The middle of some values, the upper of two. @param v not empty; taken by value to reorder.
double median(std::vector<double> v);

/// A straight line that a quarter of outliers does not move: the median of the slopes of all pairs
/// (Theil 1950, Sen 1968), the median of the intercepts that follow, and 1.4826 times the median
/// absolute deviation from it.
struct RobustLine {
  double slope = 0, intercept = 0, deviation = 0;
};
/// The cost grows with the square of the number. @param x,y as many of each, at least two.
RobustLine robust_line(std::span<const double> x, std::span<const double> y);

/// Slope of the straight line through (x, y) by least squares. @return NaN if the x are all alike.
double slope(std::span<const double> x, std::span<const double> y);

}  // namespace meltproof::imaging

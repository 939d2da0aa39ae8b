// SPDX-License-Identifier: GPL-3.0-or-later
// Discretisation uncertainty from a series of resolutions (Roache 1994; Celik et al. 2008).
#pragma once

#include <array>
#include <span>
#include <string>

namespace meltproof::validation {

/// What three resolutions tell of the numerical error.
struct GridConvergence {
  double order = 0;         ///< observed order p
  double extrapolated = 0;  ///< Richardson's value for spacing 0
  double index_fine = 0;    ///< GCI of the finest pair, as a share of the finest value
  double index_coarse = 0;  ///< GCI of the coarser pair, as a share of the middle value
  double asymptotic = 0;    ///< GCI_coarse / (r^p GCI_fine): 1 in the asymptotic range
  /// Standard uncertainty of the finest value: the GCI is read as an expanded one with k = 2.
  double uncertainty = 0;
};

/// Values on three spacings, finest first, each `ratio` times the one before.
/// p = ln((f3 - f2) / (f2 - f1)) / ln r, f_exact = f1 + (f1 - f2) / (r^p - 1),
/// GCI = safety |(f1 - f2) / f1| / (r^p - 1).
/// @throws InputError if the series oscillates, does not change or moves apart on refinement: then
/// it
///         has no observed order and no GCI.
GridConvergence grid_convergence(const std::array<double, 3>& values, double ratio,
                                 double safety = 1.25);

/// What three spacings, whatever their ratios, tell of the uncertainty of each value.
struct ResolutionSeries {
  /// "converges": monotone, and the steps shrink at least as with order 0.5. "oscillates": the
  /// steps have opposite signs. "unsettled": monotone, but the steps do not shrink so.
  std::string behaviour;
  double order = 0;         ///< observed; only where it converges
  double order_used = 0;    ///< the observed one, at most 2, which the scheme has inside the metal
  double extrapolated = 0;  ///< with order_used; only where it converges
  std::array<double, 3> uncertainty{};  ///< standard, of each value
};

/// The order p solves (f3 - f2)/(f2 - f1) = (h3^p - h2^p)/(h2^p - h1^p). Expanded uncertainties
/// (k = 2) are, where the series converges, 1.25 |f_i - f_exact| (the GCI of value i); where it
/// oscillates, half of the range (Stern et al. 2001); where it is unsettled, three times the range
/// (Eca & Hoekstra 2014).
/// @param spacings finest first, increasing. @throws InputError if they are not.
ResolutionSeries resolution_series(const std::array<double, 3>& spacings,
                                   const std::array<double, 3>& values);

/// GCI of two spacings with an assumed order: safety factor 3, because nothing was observed.
double two_grid_index(double fine, double coarse, double ratio, double order, double safety = 3.0);

/// f = f_exact + a h^p fitted through four or more noisy values by least squares (Eca & Hoekstra
/// 2014).
struct FittedConvergence {
  double order = 0, extrapolated = 0, amplitude = 0;
  double scatter = 0;  ///< standard deviation of the residuals, n - 3 degrees of freedom
};
/// @throws InputError for fewer than four values, or if no order between 0.2 and 4 fits best.
FittedConvergence fit_convergence(std::span<const double> spacings, std::span<const double> values);

}  // namespace meltproof::validation

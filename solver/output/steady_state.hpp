// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a quantity has become steady, and what it tends to if it has not.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace meltproof::solver {

/// What is asked of a series before it is called steady.
struct SteadySettings {
  double start_up = 0;         ///< s, earlier values are left out
  double least_window = 1e-4;  ///< s, shorter series are not judged
  double tolerance = 0.10;     ///< of the mean: the change over the window, with its uncertainty
  double negligible = 0.01;    ///< of the mean: a change that does not matter, however certain
  double confidence = 0.95;    ///< of the intervals that decide
};

/// Fewer independent values than this are not judged, unless they lie on a smooth curve.
inline constexpr double least_independent = 4;

/// Whether residuals stand for a curve's own bend, not for noise: so small against the quantity
/// (a quarter of a percent) that their correlation does not matter.
bool is_smooth(double residual_deviation, double quantity);

/// How many independent values n correlated ones are worth, and how long they remember.
struct EffectiveSize {
  double size = 0;   ///< n / (1 + 2 sum r_k), between 1 and n
  double lag_1 = 0;  ///< first autocorrelation, freed from its bias
};

/// **Effective sample size** of equidistant values from which `fitted` parameters of a smooth curve
/// (1 a mean, 2 a line or a two-parameter curve, 3 a parabola)
/// are already taken: the smaller of that of a first-order autoregression,
/// n (1 - r) / (1 + r) with r freed from its bias, r = (n r_1 + fitted) / (n - 4) (Kendall 1954;
/// Santer et al. 2000), and that of the sum of r_k up to the first pair that is not positive (Geyer
/// 1992).
EffectiveSize effective_size(const std::vector<double>& residuals, int fitted);

/// The verdict on one series; times in s, the rest in the series' unit, u standard uncertainties.
struct SteadyState {
  /// "steady": over the window it changes by no more than the tolerance, with 95 % confidence, and
  /// either no change is seen or a negligible one. "growing", "shrinking": a change is seen.
  /// "undecided": neither. "too short": fewer values, less time or more correlation than asked.
  std::string verdict = "too short";
  bool steady() const { return verdict == "steady"; }

  double from = 0, to = 0;      ///< the window: MSER's, at most half of the series cut (White 1997)
  std::size_t count = 0;        ///< values in it
  double effective = 0;         ///< of them independent
  double mean = 0, u_mean = 0;  ///< over the window
  double deviation = 0;         ///< sample standard deviation in the window
  double growth = 0, u_growth = 0;  ///< slope, per second
  double coverage = 0;              ///< factor from u to the interval that decided

  /// Fit of L(t) = L_inf (1 - exp(-t / tau)) to everything after the start-up; t counts from the
  /// start of the series' clock. Only where the series grows, or by more than its uncertainty while
  /// undecided, and where the fit holds: one time constant has passed, and u(L_inf) is below a
  /// quarter of L_inf. The exponential is an assumption; `fit_residual` against
  /// `deviation` shows how well it holds.
  bool has_limit = false;
  double limit = 0, u_limit = 0, tau = 0, u_tau = 0, fit_residual = 0;

  /// Change over the window, the slope times its length.
  double change() const { return growth * (to - from); }
  double u_change() const { return u_growth * (to - from); }
  /// What was found, in a sentence; values are multiplied by `scale` and given in `unit`.
  std::string sentence(const std::string& name, double scale, const std::string& unit) const;
  /// The same as numbers, `unit` in the keys ("um"), times in us, growth per ms.
  nlohmann::json json(const std::string& name, double scale, const std::string& unit) const;
};

/// Judges the series value[i] at time[i], s, increasing and about equidistant.
/// @throws std::invalid_argument if the lengths differ.
SteadyState judge_steadiness(const std::vector<double>& time, const std::vector<double>& value,
                             const SteadySettings& settings = {});

}  // namespace meltproof::solver

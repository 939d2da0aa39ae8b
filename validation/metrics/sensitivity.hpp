// SPDX-License-Identifier: GPL-3.0-or-later
// What an uncertain input does to a result, by finite differences (ASME V&V 20-2009, Section 3).
#pragma once

#include <span>

namespace meltproof::validation {

/// A run with another value of the input, and the result that it gave.
struct VariedInput {
  double input = 0, result = 0;
};

/// Derivative of a result f with respect to an input x, both as shares of their base values.
struct Sensitivity {
  double relative = 0;     ///< (df/f)/(dx/x) at the base
  double uncertainty = 0;  ///< |relative| times the input's relative standard uncertainty
  bool one_sided = false;  ///< only one run beside the base
  /// Both runs move the result to the same side: a central difference would hide that, so the
  /// steeper of the two one-sided ones counts.
  bool same_side = false;
};

/// Central difference (f_high - f_low)/f / ((x_high - x_low)/x), or with the logarithm of a factor
/// (f_high - f_low)/f / ln(x_high/x_low); one-sided against the base for a single run.
/// @param relative_uncertainty standard uncertainty of the input as a share of its value
/// @param varied one or two runs, on the two sides of `input`
/// @throws InputError for no or more than two runs, both on one side, or at the base itself, a base
///         of zero, or a factor that is not positive.
Sensitivity sensitivity(double input, double relative_uncertainty, double result,
                        std::span<const VariedInput> varied, bool logarithmic = false);

/// Relative standard uncertainty of a result that rests on one of several laws: the largest
/// distance to another law's result is the half width of a rectangular distribution, max |f_i/f -
/// 1|/sqrt(3).
/// @throws InputError for no alternative or a base of zero.
double choice_uncertainty(double result, std::span<const double> alternatives);

}  // namespace meltproof::validation

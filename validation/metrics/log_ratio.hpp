// SPDX-License-Identifier: GPL-3.0-or-later
// Bias and scatter of a model over many data of one quantity (McGrattan & Toman 2011).
#pragma once

#include <span>

namespace meltproof::validation {

/// One comparison: simulated and measured number of the same positive quantity.
struct RatioDatum {
  double simulated = 0, measured = 0;
  double relative_uncertainty =
      0;  ///< standard uncertainty of the measured number, as a share of it
};

struct LogRatio {
  std::size_t points = 0;
  double bias = 1;              ///< delta: the model gives delta times the true value on average
  double model_scatter = 0;     ///< relative standard deviation of the model about that
  double measured_scatter = 0;  ///< root mean square of the relative uncertainties
  /// The whole scatter of ln(S/D) is no larger than the measurements' own: the model's then is 0.
  bool scatter_is_noise = false;
};

/// With var = variance of ln(S/D) (n - 1): model_scatter^2 = var - measured_scatter^2 and
/// ln bias = mean ln(S/D) + (model_scatter^2 - measured_scatter^2) / 2.
/// @throws InputError for fewer than two data or a value that is not positive.
LogRatio log_ratio(std::span<const RatioDatum> data);

}  // namespace meltproof::validation

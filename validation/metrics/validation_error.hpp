// SPDX-License-Identifier: GPL-3.0-or-later
// The comparison of one number with one number after ASME V&V 20-2009.
#pragma once

#include <optional>

namespace meltproof::validation {

/// Standard uncertainties of a comparison, all in the unit of the quantity. One that was not
/// evaluated is absent; the validation uncertainty then is a lower bound.
struct ComparisonUncertainty {
  std::optional<double> numerical;  ///< u_num: resolution, time window
  std::optional<double> input;      ///< u_input: from the uncertain inputs of the simulation
  std::optional<double> data;       ///< u_D: of the measurement
};

/// What V&V 20 says of a simulated and a measured number.
struct ValidationError {
  double error = 0;        ///< E = S - D
  double uncertainty = 0;  ///< u_val = sqrt(u_num^2 + u_input^2 + u_D^2)
  double lower = 0;        ///< E - k u_val: the model's error lies in [lower, upper]
  double upper = 0;        ///< E + k u_val
  bool complete = false;   ///< all three uncertainties were evaluated
  bool within() const { return lower <= 0 && upper >= 0; }  ///< |E| <= k u_val
};

/// V&V 20, Sections 1-5 and 1-6. `coverage` is k.
/// |E| <= k u_val means that no model error can be told from the noise, not that there is none.
ValidationError validation_error(double simulated, double measured,
                                 const ComparisonUncertainty& uncertainty, double coverage);

}  // namespace meltproof::validation

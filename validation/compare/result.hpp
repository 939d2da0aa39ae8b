// SPDX-License-Identifier: GPL-3.0-or-later
// What a row turns out to be.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace meltproof::validation {

/// The numbers of a row, all in its unit. Absent: not known, or not meant for this metric.
struct RowNumbers {
  std::optional<double> simulated, measured, error;     ///< S, D, E = S - D
  std::optional<double> u_num, u_input, u_data, u_val;  ///< standard uncertainties
  std::optional<double> lower, upper;                   ///< E -+ k u_val
  bool reference_pending = false;                       ///< the reference holds no number
  std::optional<bool> rises;                            ///< of a trend: every step rises
  nlohmann::json details = nlohmann::json::object();    ///< what else the metric found
};

}  // namespace meltproof::validation

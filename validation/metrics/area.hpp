// SPDX-License-Identifier: GPL-3.0-or-later
// The area between two distributions (Ferson, Oberkampf & Ginzburg 2008).
#pragma once

#include <vector>

namespace meltproof::validation {

/// Integral of |F_S(x) - F_D(x)| over x, with the empirical distribution of each sample, in the
/// unit of the values. Zero only for equal distributions; for two single numbers their distance.
/// @throws InputError if a sample is empty.
double area_metric(std::vector<double> simulated, std::vector<double> measured);

}  // namespace meltproof::validation

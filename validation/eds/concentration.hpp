// SPDX-License-Identifier: GPL-3.0-or-later
// The concentration of AlSi10Mg along a line scan, three ways that can be held against each other.
#pragma once

#include <array>
#include <vector>

#include "validation/eds/composition.hpp"
#include "validation/eds/line_scan.hpp"

namespace meltproof::validation {

/// Concentration of AlSi10Mg along a scan. Nothing is normalised, except at% on their way to wt%.
struct ConcentrationProfile {
  std::vector<double> position;       ///< m
  std::vector<double> concentration;  ///< mass fraction of AlSi10Mg
  std::vector<double> uncertainty;    ///< standard uncertainty; empty if not reported
  std::vector<double> counting;       ///< that of the counts, sqrt(N + 2B) / N; empty if none
};

/// From aluminium. @throws InputError if the scan has none.
ConcentrationProfile concentration_from_aluminium(const LineScan& scan);
/// From silicon, with the mass fraction of silicon in the steel. @throws InputError if it has none.
ConcentrationProfile concentration_from_silicon(const LineScan& scan, double silicon_of_base);

/// Least squares over all elements at each point: w_e = p a_e + q b_e + noise, with the
/// compositions a of AlSi10Mg and b of the steel, weighted with 1 / u_e^2 where every element of
/// every point has an uncertainty (reported, or of its counts). C = p / (p + q). The amounts p and
/// q are fitted apart, so that a total off 100 % shows as p + q and does not bend C.
struct LeastSquares {
  ConcentrationProfile profile;  ///< uncertainty from the covariance of p and q
  std::vector<double> amount;    ///< p + q; 1 for a total of 100 %
  /// Covariance of p and q as pp, pq, qq: from the weights, or, without them, from the residuals.
  std::vector<std::array<double, 3>> covariance;
  /// sum (residual / u)^2 / (elements - 2): far above 1, no mixture of the two alloys has such a
  /// composition. Empty without uncertainties.
  std::vector<double> reduced_chi_square;
  bool weighted = false;
};
/// @param base mass fractions of the steel
/// @throws InputError with fewer than two elements, or if those there are cannot tell the alloys
/// apart.
LeastSquares concentration_by_least_squares(const LineScan& scan, const ElementFractions& base);

}  // namespace meltproof::validation

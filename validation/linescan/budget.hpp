// SPDX-License-Identifier: GPL-3.0-or-later
// The uncertainty of the difference between a simulated and a measured line, point by point.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "validation/metrics/validation_error.hpp"

namespace meltproof::validation {

/// Standard uncertainties at the compared points, mass fractions of AlSi10Mg. A list is empty
/// where that part is not known.
struct LineBudget {
  std::vector<double> reported;   ///< by the EDS program
  std::vector<double> counting;   ///< of the counts, sqrt(N + 2B) / N
  std::vector<double> strip;      ///< of the simulated mean over the strip
  std::vector<double> numerical;  ///< of the simulation

  /// Per point. A program's sigma is that of the counts, so the larger of the two stands for the
  /// measurement; the other parts add in quadrature. Empty where the measurement has neither.
  std::vector<double> total() const;
  std::vector<double> measured() const;
};

/// u of the mean over a strip: its scatter over sqrt(n), n the number of particles' squares that
/// the strip's area holds, at least 1: neighbours within one spacing are not independent.
double strip_uncertainty(double scatter, double width, double depth, double spacing);

/// u of a simulated profile whose edges are known to within one spacing: the slope times
/// spacing / sqrt(12). One per point; NaN beside gaps counts as no slope.
std::vector<double> edge_uncertainty(std::span<const double> position,
                                     std::span<const double> profile, double spacing);

/// V&V 20 for the mean difference of the compared points. Counting and reported uncertainties are
/// independent from point to point and shrink with sqrt(n); those of the simulation and a common
/// relative uncertainty of the quantification do not. u_input is not evaluated here.
/// @param bias E, mean simulated minus measured; @param level mean measured concentration
/// @param systematic relative standard uncertainty that all points share
ValidationError line_validation_error(double bias, double level, const LineBudget& budget,
                                      std::optional<double> systematic, double coverage,
                                      ComparisonUncertainty& parts);

}  // namespace meltproof::validation

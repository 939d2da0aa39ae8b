// SPDX-License-Identifier: GPL-3.0-or-later
// The simulated side of a line scan: the strip through the track, and what the beam sees of it.
#pragma once

#include <string>
#include <vector>

#include "validation/linescan/line_comparison.hpp"
#include "validation/linescan/strip.hpp"

namespace meltproof::validation {

/// The simulated line between its two ends (the margin beyond them has done its work).
struct SeenLine {
  StripProfile strip;
  std::vector<double> seen;       ///< the strip's mean, convolved with the interaction volume
  std::vector<double> sigma;      ///< m, of the interaction volume at each point
  std::vector<double> u_strip;    ///< standard uncertainty of the strip's mean
  std::vector<double> u_spacing;  ///< of an edge within one spacing, or what the user says
  Point beam{};
  std::string element;       ///< whose X-rays
  double edge = 0;           ///< keV
  double range = 0;          ///< m, of its X-rays in iron
  double sigma_in_iron = 0;  ///< m
  double largest_range = 0;  ///< m, of its X-rays, along the line
};

/// The X-rays are those of silicon where the concentration is taken from it, else of aluminium.
/// @throws InputError as sample_strip() or anderson_hasler_range().
SeenLine see_line(const SolidifiedTrack& track, const LineRequest& request, const Point& start,
                  const Point& end);

}  // namespace meltproof::validation

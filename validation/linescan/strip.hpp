// SPDX-License-Identifier: GPL-3.0-or-later
// The strip of the simulated track that a line scan measures: as wide as the scan and as deep as
// the X-rays come from.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "validation/linescan/solidified_track.hpp"

namespace meltproof::validation {

struct Strip {
  Point start{}, end{};  ///< m, of the line, which lies in the polished section
  double step = 0;       ///< m between the points of the line
  double margin = 0;     ///< m, sampled beyond both ends, since the beam sees beyond them
  double width = 0;      ///< m, across the line in the section; 0: none
  Point beam{};          ///< unit vector into the material, across the line
  /// Depth in m that X-rays come from, and density in kg m-3, in a matrix of concentration C.
  std::function<double(double)> depth, density;
};

/// Along the line. NaN where there is no material.
struct StripProfile {
  std::vector<double> position;  ///< m from the start, evenly spaced; below 0 in the margin
  std::vector<double> on_line;   ///< on the line itself
  std::vector<double> mean;      ///< over the strip, weighted with the density: by mass
  std::vector<double> scatter;   ///< standard deviation within the strip
  std::vector<double> density;   ///< kg m-3, of the mean; of steel where there is no material
  std::vector<double> depth;     ///< m
  std::size_t samples = 0;       ///< at each point
};

/// Samples the strip in cells of at most a quarter of the spacing, 3 to 24 across and in depth.
/// Samples outside the material are left out.
/// @throws InputError as sample_line(), or if the beam does not run across the line.
StripProfile sample_strip(const SolidifiedTrack& track, const Strip& strip);

/// The direction of the beam: "x", "-x", "y", ... or, if empty, the axis most across the line, of
/// equals x before y before z: a section across the scan is looked at along it.
/// @throws InputError for another word, or one that is not across the line (within 0.1 degree).
Point beam_direction(const std::string& axis, const Point& start, const Point& end);

}  // namespace meltproof::validation

// SPDX-License-Identifier: GPL-3.0-or-later
// Which region is the melt pool: the one that moves with the beam.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace meltproof::imaging {

/// What is known of the largest region of one frame.
struct Sighting {
  std::size_t frame = 0;
  bool whole = false;  ///< it does not touch the image's border
  double onset = 0;    ///< px along the scan, leading edge
  double across = 0;   ///< px across the scan, centroid
  double area = 0;     ///< px^2
};

/// One passage of the pool through the image.
struct Passage {
  std::vector<std::size_t> members;  ///< indices into the sightings, in the order of frames
  double speed = 0;                  ///< px a frame, of the leading edge
  double onset = 0;                  ///< px, of the line at frame 0
  double across = 0;                 ///< px, median
  double area = 0, area_spread = 0;  ///< px^2, median and robust standard deviation
  double tolerance = 0;              ///< px, how far a leading edge may be from its line
  double expected_onset(std::size_t frame) const {
    return onset + speed * static_cast<double>(frame);
  }
};

/// What is wrong with a sighting, seen from its passage.
enum class Disturbance {
  none,
  displaced,  ///< elsewhere than the beam: spatter, or a plume that has torn off
  enlarged,   ///< much larger or smaller than in the other frames: joined by plume or spatter
};

/// Parts the sightings into passages, a new one wherever the leading edge jumps back by more than a
/// quarter of `extent` (px, the image along the scan) or where no region was seen for three frames,
/// and gives each its straight line (Theil 1950, Sen 1968; from up to 60 whole sightings). Passages
/// with fewer than eight whole sightings are left out: there is nothing to compare them with, and
/// what lives that shortly is spatter if there is another passage.
/// @param sightings in the order of frames.
std::vector<Passage> find_passages(std::span<const Sighting> sightings, double extent);

/// Compares a sighting with its passage: displaced beyond the tolerance (three pixels, or five
/// robust standard deviations of the passage's leading edges if that is more) or across the scan by
/// three pixels; enlarged beyond the median area by a quarter of it and five of its deviations.
Disturbance disturbance_of(const Sighting& sighting, const Passage& passage);

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// Correction of the pixels' own offsets and gains, and of pixels that are no use.
#pragma once

#include <cstddef>
#include <vector>

namespace meltproof::imaging {

/// Offset and gain of every pixel: corrected = level + gain (value - offset). A dead pixel has the
/// gain 0.
struct Uniformity {
  double level = 0;            ///< counts, mean of the cold reference
  std::vector<double> offset;  ///< counts of each pixel in the cold reference
  std::vector<double> gain;    ///< 1
  std::size_t dead = 0;        ///< pixels
  double spread = 0;           ///< standard deviation of the living pixels' responses, relative
};

/// Two-point correction (offset and gain) from the mean frames of two uniform references, a shutter
/// or a black body at two temperatures. A pixel is dead where its response to the step is below a
/// half or above twice the median response, or is no number.
/// @param cold,hot counts, as many pixels each. @throws InputError if the sizes differ or the hot
/// reference is not brighter.
Uniformity two_point(const std::vector<double>& cold, const std::vector<double>& hot);

/// Corrects a frame in place. Pixels at or beyond `saturation` keep a value at or beyond it and all
/// others stay below it, those at or below `under_range` likewise, so that the marks of pixels that
/// cannot be believed survive; dead pixels become NaN.
/// @throws InputError if the frame has another number of pixels.
void correct(const Uniformity& uniformity, std::vector<float>& values, double saturation,
             double under_range);

}  // namespace meltproof::imaging

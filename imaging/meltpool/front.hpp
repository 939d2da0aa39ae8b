// SPDX-License-Identifier: GPL-3.0-or-later
// The solidification front by the step of the emissivity.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace meltproof::imaging {

/// Signals of the two phases at the reference temperature. Liquid metal emits less than solid metal
/// at the same temperature (liquid 0.2, solid 0.3 for steel), so behind the front the signal *rises
/// while the metal cools*: a level between the two is crossed three times there, and no level alone
/// marks the front.
struct EmissivityStep {
  double dark = 0;    ///< signal without light
  double liquid = 0;  ///< signal of liquid metal at the reference temperature
  double solid = 0;   ///< signal of solid metal there; larger
  /// The level where no step is resolved, because the temperature falls too steeply: halfway in ln
  /// S.
  double level() const;
};

/// Looks in each line along the scan axis, from its brightest pixel outwards on both sides, among
/// signals around those of `step`, for the place where ln S falls least, or even rises: there the
/// step of the emissivity, smoothed by the point spread, works against the falling temperature. It
/// counts as the front if over two pixels the slope exceeds that two pixels before and behind by at
/// least a quarter of the step; a parabola through three slopes gives its place to a fraction of a
/// pixel.
///
/// Writes into `marked` a copy of `values` in which a line with a front is at or above level() as
/// far as its front and dark behind it, so that the contour at level() (with logarithmic
/// interpolation) passes through the front. @return the number of lines with a front.
std::size_t mark_fronts(std::span<const float> values, std::size_t width, std::size_t height,
                        bool along_x, const EmissivityStep& step, std::vector<float>& marked);

}  // namespace meltproof::imaging

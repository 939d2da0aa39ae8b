// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of a recording for a person: one frame with its pool outlined, and an overview.
#pragma once

#include <string>
#include <vector>

#include "imaging/meltpool/analysis.hpp"

namespace meltproof::imaging {

/// The frame `analysis.shown`, enlarged, in false colour with its scale of values, the pool's edge
/// at its sub-pixel place, onset and end, a scale bar and what was found. @return the bytes of a
/// PNG.
std::string annotated_picture(const Recording& recording, const Analysis& analysis,
                              const PixelSize& pixel);

/// Up to 24 frames spread evenly over the recording, in the colours of one common scale.
/// @return the bytes of a PNG.
std::string contact_sheet(const Recording& recording, const Analysis& analysis);

/// Frames for an animated picture, one below the other, all of one height: those from two before
/// the first pool to two after the last one (all, where there is none), at most `most` of them at
/// equal steps, with the pool's edge, the frame's number, time, length and status.
struct FilmStrip {
  std::string png;                  ///< bytes of a PNG
  std::vector<std::size_t> frames;  ///< their numbers, from above
};
FilmStrip film_strip(const Recording& recording, const Analysis& analysis, std::size_t most = 60);

}  // namespace meltproof::imaging

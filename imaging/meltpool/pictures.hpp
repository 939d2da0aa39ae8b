// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of a recording for a person: one frame with its pool outlined, and an overview.
#pragma once

#include <string>

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

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// A picture of what was fitted, so that a person can judge it.
#pragma once

#include <vector>

#include "imaging/calibration/pixel_size.hpp"

namespace meltproof::imaging {

/// For every image: the image enlarged, with the fitted middles of its lines (green) and the
/// positions that the edges gave (red); beside it all pixels folded into one period (grey), without
/// background and contrast changes, and the model through them (green). BGR, 8 bit.
cv::Mat fit_picture(const std::vector<ScaleImage>& images, const CalibratedPixel& size);

}  // namespace meltproof::imaging

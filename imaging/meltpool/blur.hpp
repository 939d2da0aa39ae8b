// SPDX-License-Identifier: GPL-3.0-or-later
// What blurs a recording, as one Gaussian.
#pragma once

namespace meltproof::imaging {

/// Standard deviations along and across the scan, px.
struct Blur {
  double along = 0, across = 0;
};

/// The blur of a point spread (sigma, px), of a motion by `shift` px during the integration time
/// along the scan, and of pixels that average over their area. Variances add:
/// point_spread^2 + 1/12 across and point_spread^2 + 1/12 + shift^2 / 12 along.
Blur total_blur(double point_spread, double shift);

}  // namespace meltproof::imaging

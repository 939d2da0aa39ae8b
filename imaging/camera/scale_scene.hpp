// SPDX-License-Identifier: GPL-3.0-or-later
// What the camera would see of a warmed glass scale: synthetic images with a known pixel size.
#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

namespace meltproof::imaging {

/// A scale with equal, parallel lines and the optics that look at it. Defaults are the paper's
/// window.
struct ScaleScene {
  int width = 96, height = 40;                            ///< px
  double pixel_size_x = 17.6e-6, pixel_size_y = 17.6e-6;  ///< m
  double period = 100e-6;                                 ///< m, from one line to the next
  double line_width = 50e-6;                              ///< m, less than the period
  double angle = 0;           ///< rad, of the direction across the lines against image x
  double phase = 0;           ///< periods, of a line's centre against the image's centre
  double period_drift = 0;    ///< 1, relative change of the period over the image's width (tilt)
  double point_spread = 0.8;  ///< px, sigma of a Gaussian
  double glass = 4000;        ///< counts between the lines
  double contrast = 2000;     ///< counts, line minus glass, before the point spread
  double vignette = 0;        ///< 1, relative fall of the glass's level from the middle to a corner
  double noise = 100;         ///< counts, sigma; signal to noise = contrast / noise
  std::uint64_t seed = 1;
};

/// The image, height x width, CV_32F, counts. Lines blurred by the point spread are sums of erf
/// across the lines; pixels integrate them over 8 x 8 points.
cv::Mat render_scale(const ScaleScene& scene);

}  // namespace meltproof::imaging

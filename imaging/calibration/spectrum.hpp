// SPDX-License-Identifier: GPL-3.0-or-later
// From images of a scale to the first estimate of its stripes: mean, flattening, spectrum.
#pragma once

#include <stdexcept>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace meltproof::imaging {

/// There is no stripe pattern in the image that could be measured; the message says what was found.
class NoStripes : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Background of second order: 1, x, y, x^2, xy, y^2.
constexpr int background_terms = 6;

/// Position of a pixel from the image's centre: in px, and scaled so that the borders are at +-1.
struct Position {
  double x, y, scaled_x, scaled_y;
  Position(double column, double row, cv::Size size)
      : x(column - 0.5 * (size.width - 1)),
        y(row - 0.5 * (size.height - 1)),
        scaled_x(2 * x / size.width),
        scaled_y(2 * y / size.height) {}
  /// The background_terms terms at this place.
  void background(double* out) const;
};

/// The middle value (the upper one of two). `values` must not be empty.
double median(std::vector<double> values);

/// The image less its least-squares background of second order (x, y, squares and product).
cv::Mat flatten(const cv::Mat& image);

/// The highest peak of the Hann-windowed, zero-padded two-dimensional spectrum of a flattened
/// image, with parabolic interpolation. Good to some percent of a raw bin; the start of both
/// estimators.
/// @throws NoStripes if no peak stands out of the noise, if a period is shorter than 2.5 px or if
/// fewer
///         than three periods are in view.
Eigen::Vector2d coarse_frequency(const cv::Mat& flattened);

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// The spatial frequency of a stripe pattern by least squares in two dimensions.
#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "imaging/calibration/spectrum.hpp"

namespace meltproof::imaging {

/// A frequency (fx, fy) in periods per pixel along image columns and rows, with its covariance. The
/// sign is chosen so that the larger component is positive.
struct Frequency {
  Eigen::Vector2d value = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

/// The least-squares description of a stripe image.
struct StripeFit {
  Frequency frequency;
  std::vector<int> harmonics;  ///< numbers of the harmonics in the model, 1 first
  /// Coefficients: background (1, x, y, x^2, xy, y^2; x, y from the centre in half widths and half
  /// heights), then cosine and sine of every harmonic.
  Eigen::VectorXd coefficients;
  /// Contrast over the image relative to its centre: 1 + terms in x, y, x^2, xy, y^2.
  Eigen::VectorXd modulation;
  double residual = 0;     ///< counts, standard deviation of what the model leaves
  double amplitude = 0;    ///< counts, of the first harmonic
  double correlation = 0;  ///< 1, of neighbouring residuals across the lines; widens the covariance
  double drift = 0;        ///< 1, relative change of the period over the image across the lines
  double drift_uncertainty = 0;
  int excluded = 0;  ///< pixels left out: not finite, or beyond six robust sigmas
  /// The model at a pixel, without background if `flat`.
  double model(double column, double row, cv::Size size, bool flat = false) const;
};

/// Fits background + contrast * sum over harmonics k of a_k cos(2 pi k f.r) + b_k sin(2 pi k f.r)
/// by Gauss-Newton in all parameters at once; background and contrast are of second order in x and
/// y, as an unevenly warmed scale asks. Harmonics above the sampling limit are kept where their
/// alias stands apart.
/// @param image CV_64F; @throws NoStripes if the iteration leaves the peak.
StripeFit fit_stripes(const cv::Mat& image, const Eigen::Vector2d& start);

}  // namespace meltproof::imaging

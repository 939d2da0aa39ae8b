// SPDX-License-Identifier: GPL-3.0-or-later
// A second estimate of the stripe frequency that shares nothing with the first but its start:
// blurred edges are fitted line by line and their positions regressed against the line's number.
#pragma once

#include "imaging/calibration/stripes.hpp"

namespace meltproof::imaging {

/// One line of the scale in one band of image rows (of columns, if the lines lie along the rows).
struct LinePosition {
  int index = 0;      ///< number of the line, counted from the image's centre
  double column = 0;  ///< px, centre between the line's two edges
  double row = 0;     ///< px, centre of the band
};

/// The regression column = c + index / fx - row fy / fx over all lines of all bands.
struct EdgeFit {
  Frequency frequency;
  std::vector<LinePosition> lines;  ///< in image columns and rows
  double residual = 0;              ///< px, standard deviation of a line's position
  /// px, by which the lines' mean positions scatter around equal distances beyond what noise
  /// explains.
  double inequality = 0;
  /// Relative standard uncertainty of the period that follows from it.
  double inequality_uncertainty = 0;
  double line_width = 0;  ///< periods, mean distance of the two edges
  double blur = 0;        ///< px, mean sigma of the edges
  double u_blur = 0;      ///< px, its standard uncertainty by the scatter between bands
};

/// Fits, in every band of rows, a quadratic background + height sum over lines j of
///   1/2 [erf((x - c_j + w/2) / (sqrt 2 s)) - erf((x - c_j - w/2) / (sqrt 2 s))]
/// with own centres c_j and common height, width w and blur s by Levenberg-Marquardt.
/// @param image CV_64F, NaN where a pixel is missing. @param start a coarse frequency: the image
/// folded at it gives the mean profile of one period, and that gives the first guess of every edge.
/// @throws NoStripes if fewer than a third of the bands could be fitted.
EdgeFit fit_edges(const cv::Mat& image, const Eigen::Vector2d& start);

}  // namespace meltproof::imaging

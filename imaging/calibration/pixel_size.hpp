// SPDX-License-Identifier: GPL-3.0-or-later
// The size of a pixel on the object, from one or two images of a scale with equal, parallel lines.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "imaging/calibration/edges.hpp"
#include "imaging/calibration/stripes.hpp"

namespace meltproof::imaging {

/// What the certificate of the scale says, and what is meant by it.
struct Graduation {
  double length = 0;       ///< m, the stated graduation
  double uncertainty = 0;  ///< m, standard uncertainty of the graduation
  bool line_width =
      false;  ///< the graduation is the width of a line (and of a gap), not the period
  /// Distance from one line to the next, m.
  double period() const { return line_width ? 2 * length : length; }
};

/// One image of the scale, measured twice.
struct ScaleImage {
  std::string name, sha256, synthetic;
  int frames = 1;  ///< averaged
  cv::Mat image;   ///< CV_64F, NaN where no frame had a good pixel
  Eigen::Vector2d coarse = Eigen::Vector2d::Zero();
  StripeFit stripes;
  EdgeFit edges;
  double disagreement = 0;  ///< standard uncertainties between the two estimates of the period
  /// Whether the lines are crossed along image columns (x) rather than rows (y).
  bool across_x() const;
  /// rad, of the direction across the lines against that axis.
  double angle() const;
};

/// Relative standard uncertainty of the length of a frequency.
double relative_uncertainty(const Frequency& f);

/// Measures the stripes of an image (CV_64F, NaN where a pixel is missing) by both estimators.
/// @throws NoStripes if there are none; InputError if the estimators disagree by more than three
///         standard uncertainties, naming `name`.
ScaleImage measure_scale(const cv::Mat& image, const std::string& name);

/// The same from a file of any format that imaging/recording reads. All its frames are averaged; a
/// pixel counts in the frames in which it is good. @throws InputError as the reader and
/// measure_scale() do, NoStripes with the file's name in front.
ScaleImage measure_scale(const std::filesystem::path& path);

/// One entry of the uncertainty budget, relative standard uncertainties.
struct BudgetEntry {
  std::string source;
  double x = 0, y = 0;
};

/// The result.
struct CalibratedPixel {
  double x = 0, y = 0;                          ///< m
  double u_x = 0, u_y = 0;                      ///< m, standard uncertainties
  bool x_measured = false, y_measured = false;  ///< otherwise square pixels were assumed
  std::vector<BudgetEntry> budget;
};

/// Pixel size in both axes. Every image gives one equation,
///   (fx / px)^2 + (fy / py)^2 = 1 / period^2,
/// so two images, one across each axis, give both sizes and are exact for a tilted scale; with one
/// image pixels are taken as square.
/// @throws InputError for no image, more than two, two across one axis, a graduation that is not
///         positive, or a line width stated for a scale whose lines and gaps differ.
CalibratedPixel pixel_size(const std::vector<ScaleImage>& images, const Graduation& graduation);

/// The content of calibration.json, without provenance.
nlohmann::json calibration_json(const CalibratedPixel& size, const std::vector<ScaleImage>& images,
                                const Graduation& graduation);

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/calibration/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Dense>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace meltproof::imaging {

void Position::background(double* out) const {
  out[0] = 1, out[1] = scaled_x, out[2] = scaled_y;
  out[3] = scaled_x * scaled_x, out[4] = scaled_x * scaled_y, out[5] = scaled_y * scaled_y;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

cv::Mat flatten(const cv::Mat& image) {
  std::vector<cv::Point> pixels;
  for (int row = 0; row < image.rows; ++row)
    for (int column = 0; column < image.cols; ++column)
      if (std::isfinite(image.at<double>(row, column))) pixels.emplace_back(column, row);
  if (pixels.size() < 64) throw NoStripes("The image has fewer than 64 pixels with a value.");
  Eigen::MatrixXd a(static_cast<Eigen::Index>(pixels.size()), background_terms);
  Eigen::VectorXd data(a.rows());
  double terms[background_terms];
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const auto& at = pixels[static_cast<std::size_t>(i)];
    Position(at.x, at.y, image.size()).background(terms);
    for (int k = 0; k < background_terms; ++k) a(i, k) = terms[k];
    data(i) = image.at<double>(at);
  }
  const Eigen::VectorXd rest = data - a * a.householderQr().solve(data);
  cv::Mat out(image.size(), CV_64F, cv::Scalar(0));
  if (rest.norm() <= 1e-9 * data.norm()) return out;  // round-off is no pattern
  for (std::size_t i = 0; i < pixels.size(); ++i)
    out.at<double>(pixels[i]) = rest(static_cast<Eigen::Index>(i));
  return out;
}

Eigen::Vector2d coarse_frequency(const cv::Mat& flattened) {
  const cv::Size size = flattened.size();
  if (size.width < 8 || size.height < 8)
    throw NoStripes(fmt::format("The image has only {} x {} px; at least 8 x 8 are needed.",
                                size.width, size.height));
  const auto padded_length = [](int n) { return cv::getOptimalDFTSize(8 * n); };
  const cv::Size padded_size(padded_length(size.width), padded_length(size.height));
  cv::Mat window, padded(padded_size, CV_64F, cv::Scalar(0)), spectrum;
  cv::createHanningWindow(window, size, CV_64F);
  padded(cv::Rect({0, 0}, size)) = flattened.mul(window);
  cv::dft(padded, spectrum, cv::DFT_COMPLEX_OUTPUT);

  const auto power = [&](int i, int j) {
    const int row = (j + padded_size.height) % padded_size.height;
    const int column = (i + padded_size.width) % padded_size.width;
    const auto& z = spectrum.at<cv::Vec2d>(row, column);
    return z[0] * z[0] + z[1] * z[1];
  };
  // Half the plane is enough. The window's main lobe around zero, four raw bins wide, holds what is
  // left of the background.
  double best = 0;
  int best_i = 0, best_j = 0;
  std::vector<double> all;
  for (int j = -padded_size.height / 2 + 1; j < padded_size.height / 2; ++j)
    for (int i = 0; i < padded_size.width / 2; ++i) {
      const double fx = static_cast<double>(i) / padded_size.width;
      const double fy = static_cast<double>(j) / padded_size.height;
      if (std::hypot(fx * size.width, fy * size.height) < 2.5) continue;
      const double p = power(i, j);
      all.push_back(p);
      if (p > best) best = p, best_i = i, best_j = j;
    }
  // The largest of some thousand exponentially distributed powers is about 13 medians.
  const double typical = median(std::move(all));
  if (!(best > 40 * typical) || !(best > 0))
    throw NoStripes(fmt::format(
        "No stripes were found: the highest peak of the spectrum is only {:.1f} times its median, "
        "and 40 times is asked.",
        typical > 0 ? best / typical : 0.0));
  const auto vertex = [](double l, double m, double r) {
    l = std::log(l + 1e-300), m = std::log(m + 1e-300), r = std::log(r + 1e-300);
    const double curvature = l - 2 * m + r;
    return curvature < 0 ? std::clamp(0.5 * (l - r) / curvature, -0.5, 0.5) : 0.0;
  };
  Eigen::Vector2d f((best_i + vertex(power(best_i - 1, best_j), best, power(best_i + 1, best_j))) /
                        padded_size.width,
                    (best_j + vertex(power(best_i, best_j - 1), best, power(best_i, best_j + 1))) /
                        padded_size.height);
  if (std::abs(f.y()) > std::abs(f.x()) ? f.y() < 0 : f.x() < 0) f = -f;
  const bool across_columns = std::abs(f.x()) >= std::abs(f.y());
  const double larger = across_columns ? f.x() : f.y();
  const int extent = across_columns ? size.width : size.height;
  if (larger > 0.4)
    throw NoStripes(
        fmt::format("The period of the stripes is {:.2f} px; at least 2.5 px are needed "
                    "to tell a stripe from its alias.",
                    1 / larger));
  if (larger * extent < 2.9)
    throw NoStripes(
        fmt::format("Only {:.1f} periods of the stripes are in view; at least 3 are "
                    "needed.",
                    larger * extent));
  return f;
}

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/calibration/stripes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>

namespace meltproof::imaging {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;
constexpr int most_harmonics = 5;

/// Distance of a frequency from the next whole number, in raw bins of the image.
double bins_from_zero(const Eigen::Vector2d& f, cv::Size size) {
  return std::max(std::abs(f.x() - std::round(f.x())) * size.width,
                  std::abs(f.y() - std::round(f.y())) * size.height);
}

/// Harmonics whose samples differ from the background's and from every lower harmonic's: one above
/// the sampling limit is as good as any other as long as its alias does not meet another term.
std::vector<int> usable_harmonics(const Eigen::Vector2d& f, cv::Size size) {
  constexpr double apart = 2;  // raw bins
  std::vector<int> out{1};
  for (int k = 2; k <= most_harmonics; ++k) {
    bool usable = bins_from_zero(k * f, size) > apart && bins_from_zero(2 * k * f, size) > apart;
    for (const int j : out)
      usable = usable && bins_from_zero((k - j) * f, size) > apart &&
               bins_from_zero((k + j) * f, size) > apart;
    if (usable) out.push_back(k);
  }
  return out;
}

/// Where the iteration stands: the nonlinear parameters.
struct State {
  Eigen::Vector2d f;
  Eigen::VectorXd modulation = Eigen::VectorXd::Zero(background_terms - 1);

  /// Contrast at a pixel relative to the image's centre: 1 + sum of modulation terms x, y, ....
  double contrast(const double* terms) const {
    double out = 1;
    for (int k = 1; k < background_terms; ++k) out += modulation(k - 1) * terms[k];
    return out;
  }
};

struct Solution {
  Eigen::VectorXd
      parameters;  // linear; changes of the modulation, of fx, fy and of the drift if asked
  Eigen::VectorXd residuals;
  Eigen::MatrixXd inverse_normal;
  Eigen::Index frequency_at = 0;  // place of fx's change
};

/// One Gauss-Newton step: the linear parameters at `state`, then all of them with the derivatives.
Solution step(const cv::Mat& image, const std::vector<cv::Point>& pixels, const State& state,
              const std::vector<int>& harmonics, bool with_drift) {
  const auto n = static_cast<Eigen::Index>(pixels.size());
  const auto linear = background_terms + 2 * static_cast<Eigen::Index>(harmonics.size());
  Solution out;
  out.frequency_at = linear + background_terms - 1;
  Eigen::MatrixXd a(n, out.frequency_at + (with_drift ? 3 : 2));
  Eigen::VectorXd data(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& at = pixels[static_cast<std::size_t>(i)];
    const Position p(at.x, at.y, image.size());
    double terms[background_terms];
    p.background(terms);
    for (int k = 0; k < background_terms; ++k) a(i, k) = terms[k];
    const double contrast = state.contrast(terms);
    for (std::size_t k = 0; k < harmonics.size(); ++k) {
      const double phase = two_pi * harmonics[k] * (state.f.x() * p.x + state.f.y() * p.y);
      const auto column = background_terms + 2 * static_cast<Eigen::Index>(k);
      a(i, column) = contrast * std::cos(phase);
      a(i, column + 1) = contrast * std::sin(phase);
    }
    data(i) = image.at<double>(at);
  }
  const Eigen::VectorXd c = a.leftCols(linear).householderQr().solve(data);
  // Over the image the phase then gains drift/2 * along^2 / length: the period changes linearly.
  const double length = std::abs(state.f.x()) * image.cols + std::abs(state.f.y()) * image.rows;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& at = pixels[static_cast<std::size_t>(i)];
    const Position p(at.x, at.y, image.size());
    double slope = 0, stripes = 0;  // derivative of the model by the phase in periods; its stripes
    for (std::size_t k = 0; k < harmonics.size(); ++k) {
      const auto at_k = background_terms + 2 * static_cast<Eigen::Index>(k);
      slope += two_pi * harmonics[k] * (-c(at_k) * a(i, at_k + 1) + c(at_k + 1) * a(i, at_k));
      stripes += c(at_k) * a(i, at_k) + c(at_k + 1) * a(i, at_k + 1);
    }
    double terms[background_terms];
    p.background(terms);
    const double contrast = state.contrast(terms);
    for (int k = 1; k < background_terms; ++k) a(i, linear + k - 1) = stripes / contrast * terms[k];
    a(i, out.frequency_at) = slope * p.x;
    a(i, out.frequency_at + 1) = slope * p.y;
    if (with_drift) {
      const double along = state.f.x() * p.x + state.f.y() * p.y;
      a(i, out.frequency_at + 2) = -0.5 * slope * along * along / length;
    }
  }
  out.parameters = a.colPivHouseholderQr().solve(data);
  out.residuals = data - a * out.parameters;
  out.inverse_normal = (a.transpose() * a).inverse();
  return out;
}

/// Correlation of neighbouring residuals in the direction across the lines.
double neighbour_correlation(const Eigen::VectorXd& residuals, const std::vector<cv::Point>& pixels,
                             cv::Size size, bool across_columns) {
  cv::Mat field(size, CV_64F, cv::Scalar(0));
  for (std::size_t i = 0; i < pixels.size(); ++i)
    field.at<double>(pixels[i]) = residuals(static_cast<Eigen::Index>(i));
  const int dx = across_columns ? 1 : 0, dy = across_columns ? 0 : 1;
  double product = 0, square = 0;
  for (int row = 0; row + dy < size.height; ++row)
    for (int column = 0; column + dx < size.width; ++column) {
      product += field.at<double>(row, column) * field.at<double>(row + dy, column + dx);
      square += field.at<double>(row, column) * field.at<double>(row, column);
    }
  return square > 0 ? product / square : 0;
}

}  // namespace

StripeFit fit_stripes(const cv::Mat& image, const Eigen::Vector2d& start) {
  std::vector<cv::Point> pixels;
  for (int row = 0; row < image.rows; ++row)
    for (int column = 0; column < image.cols; ++column)
      if (std::isfinite(image.at<double>(row, column))) pixels.emplace_back(column, row);

  StripeFit fit;
  fit.harmonics = usable_harmonics(start, image.size());
  State state{start};
  Solution s;
  const auto iterate = [&] {
    for (int i = 0; i < 50; ++i) {
      s = step(image, pixels, state, fit.harmonics, false);
      const Eigen::Vector2d change = s.parameters.segment<2>(s.frequency_at);
      state.f += change;
      state.modulation +=
          s.parameters.segment(s.frequency_at - background_terms + 1, background_terms - 1);
      const Eigen::Vector2d moved = (state.f - start).cwiseAbs();
      if (!(moved.x() * image.cols < 1 && moved.y() * image.rows < 1))
        throw NoStripes(
            "The least-squares fit moved by more than a bin of the spectrum away from its "
            "peak: the pattern is not periodic enough to be measured.");
      if (change.norm() < 1e-12) return;
    }
  };
  iterate();
  // Dust and dead pixels: once, by a robust measure of the scatter.
  std::vector<double> sizes(static_cast<std::size_t>(s.residuals.size()));
  for (std::size_t i = 0; i < sizes.size(); ++i)
    sizes[i] = std::abs(s.residuals(static_cast<Eigen::Index>(i)));
  const double limit = 6 * 1.4826 * median(sizes);
  std::vector<cv::Point> kept;
  for (std::size_t i = 0; i < pixels.size(); ++i)
    if (sizes[i] <= limit) kept.push_back(pixels[i]);
  if (kept.size() < pixels.size() && kept.size() > pixels.size() / 2) {
    pixels = std::move(kept);
    iterate();
  }
  fit.excluded = image.rows * image.cols - static_cast<int>(pixels.size());

  const auto at = s.frequency_at;
  const bool across_columns = std::abs(state.f.x()) >= std::abs(state.f.y());
  fit.coefficients = s.parameters.head(at - background_terms + 1);
  fit.modulation = state.modulation;
  fit.amplitude =
      std::hypot(fit.coefficients(background_terms), fit.coefficients(background_terms + 1));
  const double variance =
      s.residuals.squaredNorm() / static_cast<double>(s.residuals.size() - s.parameters.size());
  fit.residual = std::sqrt(variance);
  fit.correlation = neighbour_correlation(s.residuals, pixels, image.size(), across_columns);
  const double r = std::clamp(fit.correlation, 0.0, 0.9);
  const double widened = variance * (1 + r) / (1 - r);
  fit.frequency.value = state.f;
  fit.frequency.covariance = widened * s.inverse_normal.block<2, 2>(at, at);
  s = step(image, pixels, state, fit.harmonics, true);
  fit.drift = s.parameters(at + 2);
  fit.drift_uncertainty = std::sqrt(widened * s.inverse_normal(at + 2, at + 2));
  return fit;
}

double StripeFit::model(double column, double row, cv::Size size, bool flat) const {
  const Position p(column, row, size);
  double terms[background_terms], value = 0;
  p.background(terms);
  const double contrast = State{frequency.value, modulation}.contrast(terms);
  for (int k = 0; k < background_terms && !flat; ++k) value += coefficients(k) * terms[k];
  for (std::size_t k = 0; k < harmonics.size(); ++k) {
    const double phase =
        two_pi * harmonics[k] * (frequency.value.x() * p.x + frequency.value.y() * p.y);
    const auto at = background_terms + 2 * static_cast<Eigen::Index>(k);
    value +=
        contrast * (coefficients(at) * std::cos(phase) + coefficients(at + 1) * std::sin(phase));
  }
  return value;
}

}  // namespace meltproof::imaging

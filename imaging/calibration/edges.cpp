// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/calibration/edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <Eigen/Dense>
#include <fmt/format.h>
#include <unsupported/Eigen/NonLinearOptimization>

namespace meltproof::imaging {
namespace {

/// The parameters of a band before the lines' centres.
enum Shared : Eigen::Index {
  offset,
  slope,
  curvature,
  height,
  height_slope,  // the warmer middle of the scale has the higher contrast
  height_curvature,
  log_width,
  log_blur,
  shared_count
};

/// Sum of squares of one band, in the form that Eigen's Levenberg-Marquardt takes. Weak priors on
/// width and blur decide only what the data leave open: a line much thinner than the blur has no
/// width.
struct Band {
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  Eigen::VectorXd profile;  // NaN where every pixel is missing
  double noise = 1;         // of the profile's values, sets the priors' weight
  Eigen::VectorXd prior;    // first guess of all parameters
  double centre_prior =
      0.5;  // px: keeps lines at the border, which show one edge or none, in place

  Eigen::Index inputs() const { return prior.size(); }
  Eigen::Index values() const { return profile.size() + 2 + lines(); }
  Eigen::Index lines() const { return prior.size() - shared_count; }
  double line_prior_weight(Eigen::Index line) const {
    const double centre = prior(shared_count + line), w = 0.5 * std::exp(prior(log_width));
    const bool whole = centre - w > 0.5 && centre + w < static_cast<double>(profile.size()) - 1.5;
    return whole ? 0.0 : noise / centre_prior * 4;
  }

  int operator()(const Eigen::VectorXd& p, Eigen::VectorXd& out) const {
    evaluate(p, &out, nullptr);
    return 0;
  }
  int df(const Eigen::VectorXd& p, Eigen::MatrixXd& out) const {
    evaluate(p, nullptr, &out);
    return 0;
  }
  void evaluate(const Eigen::VectorXd& p, Eigen::VectorXd* value, Eigen::MatrixXd* jacobian) const {
    const Eigen::Index n = profile.size();
    const double width = std::exp(p(log_width)), blur = std::exp(p(log_blur));
    const double root = std::numbers::sqrt2 * blur;
    const double normal = 1 / (blur * std::sqrt(2 * std::numbers::pi));
    if (jacobian) jacobian->setZero();
    for (Eigen::Index i = 0; i < n; ++i) {
      const double x = static_cast<double>(i);
      const double scaled = 2 * x / static_cast<double>(n - 1) - 1;
      if (!std::isfinite(profile(i))) {
        if (value) (*value)(i) = 0;
        continue;
      }
      const double tall = p(height) + scaled * (p(height_slope) + scaled * p(height_curvature));
      double sum = 0, by_width = 0, by_blur = 0;
      for (Eigen::Index k = 0; k < lines(); ++k) {
        const double left = x - p(shared_count + k) + 0.5 * width, right = left - width;
        if (std::min(std::abs(left), std::abs(right)) > 8 * blur && left * right > 0) continue;
        sum += 0.5 * (std::erf(left / root) - std::erf(right / root));
        if (!jacobian) continue;
        const double l = normal * std::exp(-left * left / (root * root));
        const double r = normal * std::exp(-right * right / (root * root));
        (*jacobian)(i, shared_count + k) = tall * (r - l);
        by_width += 0.5 * (l + r);
        by_blur += (right * r - left * l) / blur;
      }
      if (value) {
        (*value)(i) =
            p(offset) + scaled * (p(slope) + scaled * p(curvature)) + tall * sum - profile(i);
      }
      if (!jacobian) continue;
      (*jacobian)(i, offset) = 1;
      (*jacobian)(i, slope) = scaled;
      (*jacobian)(i, curvature) = scaled * scaled;
      (*jacobian)(i, height) = sum;
      (*jacobian)(i, height_slope) = scaled * sum;
      (*jacobian)(i, height_curvature) = scaled * scaled * sum;
      (*jacobian)(i, log_width) = tall * by_width * width;
      (*jacobian)(i, log_blur) = tall * by_blur * blur;
    }
    for (Eigen::Index k = 0; k < 2; ++k) {
      const double weight = noise / 0.3;
      if (value) (*value)(n + k) = weight * (p(log_width + k) - prior(log_width + k));
      if (jacobian) (*jacobian)(n + k, log_width + k) = weight;
    }
    for (Eigen::Index k = 0; k < lines(); ++k) {
      const double weight = line_prior_weight(k);
      if (value) (*value)(n + 2 + k) = weight * (p(shared_count + k) - prior(shared_count + k));
      if (jacobian) (*jacobian)(n + 2 + k, shared_count + k) = weight;
    }
  }
};

/// The mean profile of one period: where a line rises and falls, in periods, and how high it is.
struct Folded {
  double centre = 0, width = 0.5, height = 1, base = 0;
};

Folded fold(const cv::Mat& image, const Eigen::Vector2d& f) {
  constexpr int bins = 24;
  std::array<double, bins> sum{}, count{};
  for (int row = 0; row < image.rows; ++row)
    for (int column = 0; column < image.cols; ++column) {
      const double p = f.x() * column + f.y() * row;
      const auto bin = static_cast<std::size_t>((p - std::floor(p)) * bins) % bins;
      sum[bin] += image.at<double>(row, column);
      count[bin] += 1;
    }
  for (std::size_t i = 0; i < bins; ++i) sum[i] /= std::max(count[i], 1.0);
  const auto [low, high] = std::minmax_element(sum.begin(), sum.end());
  const double middle = 0.5 * (*low + *high);
  // The first moment on the circle of what lies above the middle is the line's centre.
  double c = 0, s = 0, above = 0;
  for (std::size_t i = 0; i < bins; ++i) {
    if (sum[i] <= middle) continue;
    const double angle = 2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / bins;
    c += (sum[i] - middle) * std::cos(angle);
    s += (sum[i] - middle) * std::sin(angle);
    above += 1;
  }
  return {std::atan2(s, c) / (2 * std::numbers::pi), above / bins, *high - *low, *low};
}

std::vector<LinePosition> fit_band(const Eigen::VectorXd& profile, double row,
                                   const Eigen::Vector2d& f, const Folded& folded, double noise,
                                   double& width, double& blur) {
  const double last = static_cast<double>(profile.size() - 1);
  const auto line_at = [&](double x) { return f.x() * x + f.y() * row - folded.centre; };
  // One line beyond either border: its edge or its blur may reach into view.
  const int first_line = static_cast<int>(std::floor(line_at(0))),
            last_line = static_cast<int>(std::ceil(line_at(last)));
  double mean = 0;  // of the pixels that are there: what flatten() has taken off folded.base
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < profile.size(); ++i)
    if (std::isfinite(profile(i))) mean += profile(i), ++count;
  if (count < profile.size() / 2) return {};
  mean /= static_cast<double>(count);
  Band band;
  band.profile = profile;
  band.noise = noise;
  band.prior.resize(shared_count + last_line - first_line + 1);
  band.prior.head(shared_count) << mean + folded.base, 0, 0, folded.height, 0, 0,
      std::log(folded.width / f.x()), std::log(0.8);
  for (int j = first_line; j <= last_line; ++j)
    band.prior(shared_count + j - first_line) = (j + folded.centre - f.y() * row) / f.x();
  Eigen::VectorXd p = band.prior;
  Eigen::LevenbergMarquardt<Band> solver(band);
  solver.parameters.maxfev = 200;
  solver.parameters.xtol = solver.parameters.ftol = 1e-10;
  const auto status = solver.minimize(p);
  width = std::exp(p(log_width)) * f.x();
  blur = std::exp(p(log_blur));
  std::vector<LinePosition> out;
  if (status == Eigen::LevenbergMarquardtSpace::ImproperInputParameters || !p.allFinite())
    return out;
  for (int j = first_line; j <= last_line; ++j)
    if (band.line_prior_weight(j - first_line) == 0)
      out.push_back({j, p(shared_count + j - first_line), row});
  return out;
}

/// column = a + b index + c row, with the positions beyond four robust sigmas left out once.
void regress(EdgeFit& fit) {
  Eigen::Matrix3d inverse;
  Eigen::Vector3d solution;
  for (int pass = 0;; ++pass) {
    Eigen::MatrixXd a(static_cast<Eigen::Index>(fit.lines.size()), 3);
    Eigen::VectorXd data(a.rows());
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      const auto& line = fit.lines[static_cast<std::size_t>(i)];
      a.row(i) << 1, line.index, line.row;
      data(i) = line.column;
    }
    solution = a.colPivHouseholderQr().solve(data);
    const Eigen::VectorXd rest = data - a * solution;
    fit.residual = std::sqrt(rest.squaredNorm() / static_cast<double>(a.rows() - 3));
    inverse = (a.transpose() * a).inverse();
    if (pass == 1) break;
    std::vector<double> sizes(fit.lines.size());
    for (std::size_t i = 0; i < sizes.size(); ++i)
      sizes[i] = std::abs(rest(static_cast<Eigen::Index>(i)));
    const double limit = 4 * 1.4826 * median(sizes) + 1e-9;
    std::vector<LinePosition> kept;
    for (std::size_t i = 0; i < sizes.size(); ++i)
      if (sizes[i] <= limit) kept.push_back(fit.lines[i]);
    if (kept.size() > fit.lines.size() / 2) fit.lines = std::move(kept);
  }
  // Noise differs from band to band, a misplaced line does not: its mean over the bands tells.
  std::map<int, std::pair<double, int>> deviations;
  for (const auto& line : fit.lines) {
    auto& [sum, count] = deviations[line.index];
    sum += line.column - solution(0) - solution(1) * line.index - solution(2) * line.row;
    ++count;
  }
  double scatter = 0, expected = 0, mean_index = 0, spread = 0;
  const auto number = static_cast<double>(deviations.size());
  for (const auto& [index, deviation] : deviations) {
    const double mean = deviation.first / deviation.second;
    scatter += mean * mean / number;
    expected += fit.residual * fit.residual / deviation.second / number;
    mean_index += index / number;
  }
  for (const auto& [index, deviation] : deviations) spread += std::pow(index - mean_index, 2);
  // A sum of squares of `number` noises scatters by sqrt(2 / number) of itself.
  const bool significant = scatter > expected * (1 + 3 * std::sqrt(2 / number));
  fit.inequality = significant ? std::sqrt(scatter - expected) : 0.0;
  fit.inequality_uncertainty = fit.inequality / std::sqrt(spread) / std::abs(solution(1));

  // fx = 1/b, fy = -c/b
  const double b = solution(1), c = solution(2);
  fit.frequency.value = {1 / b, -c / b};
  Eigen::Matrix2d jacobian;
  jacobian << -1 / (b * b), 0, c / (b * b), -1 / b;
  fit.frequency.covariance =
      jacobian * (fit.residual * fit.residual * inverse.block<2, 2>(1, 1)) * jacobian.transpose();
}

}  // namespace

EdgeFit fit_edges(const cv::Mat& image, const Eigen::Vector2d& start) {
  if (std::abs(start.y()) > std::abs(start.x())) {  // lines along the rows: the same, transposed
    EdgeFit turned = fit_edges(image.t(), {start.y(), start.x()});
    std::swap(turned.frequency.value.x(), turned.frequency.value.y());
    turned.frequency.covariance = turned.frequency.covariance.reverse().eval();
    for (auto& line : turned.lines) std::swap(line.column, line.row);
    return turned;
  }
  const cv::Mat flattened = flatten(image);
  const Folded folded = fold(flattened, start);
  // Rows are averaged as long as the lines move by less than a tenth of a pixel over a band, but
  // enough bands are kept to see the tilt.
  const double shift = std::abs(start.y() / start.x());  // px per row
  const int band_rows = std::clamp(static_cast<int>(0.1 / std::max(shift, 1e-6)), 1,
                                   std::max(1, flattened.rows / 10));
  cv::Mat difference = flattened(cv::Rect(0, 1, flattened.cols, flattened.rows - 1)) -
                       flattened(cv::Rect(0, 0, flattened.cols, flattened.rows - 1));
  const double noise = cv::norm(difference, cv::NORM_L2) /
                       std::sqrt(2.0 * static_cast<double>(difference.total()) * band_rows);
  EdgeFit fit;
  int bands = 0, fitted = 0;
  std::vector<double> blurs;
  for (int first = 0; first + band_rows <= flattened.rows; first += band_rows, ++bands) {
    // A column with a missing pixel is missing from the whole band: a mean over fewer rows would
    // belong to another row than the band's centre.
    Eigen::VectorXd profile = Eigen::VectorXd::Zero(image.cols);
    for (int row = first; row < first + band_rows; ++row)
      for (int column = 0; column < image.cols; ++column)
        profile(column) += image.at<double>(row, column) / band_rows;
    double width = 0, blur = 0;
    const auto lines =
        fit_band(profile, first + 0.5 * (band_rows - 1), start, folded, noise, width, blur);
    if (lines.empty()) continue;
    fit.lines.insert(fit.lines.end(), lines.begin(), lines.end());
    fit.line_width += width;
    fit.blur += blur;
    blurs.push_back(blur);
    ++fitted;
  }
  if (3 * fitted < bands || fit.lines.size() < 6)
    throw NoStripes(
        fmt::format("The edges of the stripes could be fitted in only {} of {} bands of the "
                    "image.",
                    fitted, bands));
  fit.line_width /= fitted;
  fit.blur /= fitted;
  double squares = 0;
  for (const double blur : blurs) squares += (blur - fit.blur) * (blur - fit.blur);
  fit.u_blur = std::sqrt(squares / std::max(1, fitted - 1) / fitted);
  regress(fit);
  return fit;
}

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/blurred_fit.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace meltproof::imaging::blurred_fit {
namespace {

double softplus(double x) { return x > 30 ? x : std::log1p(std::exp(x)); }
double logistic(double x) { return 1 / (1 + std::exp(-x)); }

cv::Mat gaussian(double sigma) {
  return cv::getGaussianKernel(2 * static_cast<int>(std::ceil(4 * sigma)) + 1, sigma, CV_64F);
}

/// Powers of y within powers of x; in a side view powers of y^2 up to the fourth of y alone, since
/// the pool is the upper half's mirror image below the plate's surface.
void basis(const Patch& patch, double x, double y, double* out) {
  const double factor = patch.even ? y * y : y;
  double px = 1;
  for (int i = 0; i <= along_order; ++i, px *= x) {
    double py = px;
    for (int j = 0; j <= across_order; ++j, py *= factor)
      *out++ = patch.even && j > across_order / 2 ? 0 : py;
  }
}

}  // namespace

double theta_at(const Patch& patch, const Vector& p, double x, double y) {
  double b[terms], theta = 0;
  basis(patch, x, y, b);
  for (int k = 0; k < terms; ++k) theta += p(k) * b[k];
  return theta;
}

std::optional<Patch> make_patch(const Stack& stack, double dark, const Blur& blur,
                                const PlateEdge& edge, double start, End end) {
  const std::vector<float> smooth = smoothed(stack, 0.5, 0);
  const double level = dark + std::exp(start);
  const auto columns = static_cast<std::ptrdiff_t>(stack.columns);
  std::vector<std::ptrdiff_t> crossing(stack.lines, -1);
  std::ptrdiff_t lowest = columns, tip = -1, tail = 0;
  for (std::size_t l = 0; l < stack.lines; ++l) {
    if (edge.present && static_cast<double>(l) < edge.row) continue;
    const float* const v = smooth.data() + l * stack.columns;
    const auto peak = std::max_element(v, v + columns) - v;
    if (static_cast<double>(v[peak]) < level) continue;
    std::ptrdiff_t i = peak;
    while (i > 0 && static_cast<double>(v[i - 1]) >= level) --i;
    crossing[l] = i;
    if (i >= lowest) continue;
    lowest = i;
    tip = static_cast<std::ptrdiff_t>(l);
    // The hottest part, under the beam, is no tail: it may be flat, saturated or boiling.
    tail = peak;
    while (tail > 0 &&
           static_cast<double>(v[tail]) - dark > 0.8 * (static_cast<double>(v[peak]) - dark))
      --tail;
  }
  if (tip < 0) return std::nullopt;
  const double pixels = end == End::tail ? reach : leading_reach;
  const auto r = static_cast<std::ptrdiff_t>(pixels * Stack::samples);
  std::ptrdiff_t first_line = tip, last_line = tip, inner = lowest;
  // Neighbouring lines as long as their front lies within reach of the tip's.
  const auto belongs = [&](std::ptrdiff_t l) {
    return l >= 0 && l < static_cast<std::ptrdiff_t>(stack.lines) &&
           crossing[static_cast<std::size_t>(l)] >= 0 &&
           crossing[static_cast<std::size_t>(l)] - lowest <= r;
  };
  while (belongs(first_line - 1) && tip - first_line < 5) --first_line;
  while (belongs(last_line + 1) && last_line - tip < 5) ++last_line;
  for (std::ptrdiff_t l = first_line; l <= last_line; ++l)
    inner = std::max(inner, crossing[static_cast<std::size_t>(l)]);
  const std::ptrdiff_t from = std::max<std::ptrdiff_t>(lowest - r, 0),
                       to = std::min(lowest + r, end == End::tail ? tail : columns);
  const auto samples = static_cast<std::ptrdiff_t>(Stack::samples);
  if (end == End::tail && (to - from < 8 * samples || to - lowest < 2 * samples))
    return std::nullopt;
  Patch patch;
  patch.highest = start + 4;
  patch.scale = end == End::tail ? 6 : 2.5;
  patch.column = static_cast<std::size_t>(from);
  patch.columns = static_cast<int>(to - from);
  patch.line = static_cast<std::size_t>(first_line);
  patch.lines = static_cast<int>(last_line - first_line + 1);
  patch.along = gaussian(blur.along * Stack::samples);
  patch.across = gaussian(blur.across * fine);
  patch.margin_columns = patch.along.rows / 2;
  patch.margin_rows = patch.across.rows / 2;
  patch.centre_column = static_cast<double>(lowest);
  patch.even = edge.present;
  patch.centre_line = edge.present ? edge.row : static_cast<double>(tip);
  for (int row = 0; row < patch.height(); ++row)
    patch.mask.push_back(
        edge.present ? std::clamp((patch.row(row) - edge.row) * fine + 0.5, 0.0, 1.0) : 1.0);
  for (std::ptrdiff_t l = first_line; l <= last_line; ++l)
    patch.crossing.push_back(static_cast<int>(crossing[static_cast<std::size_t>(l)] - from));
  const double per_column = static_cast<double>(stack.frames) / Stack::samples;
  std::size_t used = 0;
  for (int l = 0; l < patch.lines; ++l)
    for (int c = 0; c < patch.columns; ++c) {
      const std::size_t i = (patch.line + static_cast<std::size_t>(l)) * stack.columns +
                            patch.column + static_cast<std::size_t>(c);
      const double s = static_cast<double>(stack.signal[i]) - dark;
      const double u2 = 0.5 * std::pow(static_cast<double>(stack.deviation[i]), 2) +
                        0.5 * stack.noise * stack.noise / per_column + std::pow(0.003 * s, 2);
      const bool known = std::isfinite(s) && s > (end == End::tail ? 0.15 : 0.03) * std::exp(start);
      patch.value.push_back(known ? s : 0);
      patch.weight.push_back(known ? 1 / u2 : 0);
      patch.smooth.push_back(
          std::max(static_cast<double>(smooth[i]) - dark, 1e-3 * std::exp(start)));
      used += known ? 1 : 0;
    }
  if (used < static_cast<std::size_t>((end == End::tail ? 4 : 2) * terms)) return std::nullopt;
  return patch;
}

double Linearised::total() const {
  double sum = 0;
  for (const double c : chi_squared) sum += c;
  return sum;
}

Linearised linearise(const Patch& patch, const Vector& p, bool derivatives) {
  const int w = patch.width(), h = patch.height();
  const int images = derivatives ? parameters : 0;
  std::vector<cv::Mat> derivative(static_cast<std::size_t>(images));
  for (auto& m : derivative) m.create(h, w, CV_64F);
  cv::Mat signal(h, w, CV_64F);
  const double width = p(interval);
  double b[terms];
  for (int r = 0; r < h; ++r)
    for (int c = 0; c < w; ++c) {
      basis(patch, patch.x(c), patch.y(r), b);
      double theta = 0;
      for (int k = 0; k < terms; ++k) theta += p(k) * b[k];
      const double u = (p(theta_star) - theta) / softness, v = u - width / softness;
      const double ramp = (softplus(u) - softplus(v)) * softness / width;
      const double slope = (logistic(u) - logistic(v)) / width;
      const double log_s = std::min(theta + p(rise) * ramp, patch.highest);
      const double s = patch.mask[static_cast<std::size_t>(r)] * std::exp(log_s);
      signal.at<double>(r, c) = s;
      if (!derivatives) continue;
      const double by_theta = s * (1 - p(rise) * slope);
      for (int k = 0; k < terms; ++k)
        derivative[static_cast<std::size_t>(k)].at<double>(r, c) = by_theta * b[k];
      derivative[theta_star].at<double>(r, c) = s * p(rise) * slope;
      derivative[rise].at<double>(r, c) = s * ramp;
      derivative[interval].at<double>(r, c) = s * p(rise) * (logistic(v) - ramp) / width;
    }
  const auto blur = [&](cv::Mat& m) {
    cv::sepFilter2D(m, m, CV_64F, patch.along, patch.across, {-1, -1}, 0, cv::BORDER_REPLICATE);
  };
  blur(signal);
  for (auto& m : derivative) blur(m);

  Linearised result;
  result.blurred = signal;
  result.normal.assign(static_cast<std::size_t>(patch.lines), Matrix::Zero());
  result.gradient.assign(static_cast<std::size_t>(patch.lines), Vector::Zero());
  result.chi_squared.assign(static_cast<std::size_t>(patch.lines), 0);
  Vector j;
  for (int l = 0; l < patch.lines; ++l)
    for (int c = 0; c < patch.columns; ++c) {
      const auto i = static_cast<std::size_t>(l * patch.columns + c);
      if (patch.weight[i] == 0) continue;
      const int row = patch.margin_rows + l * fine + fine / 2, column = patch.margin_columns + c;
      const double residual = patch.value[i] - signal.at<double>(row, column);
      result.chi_squared[static_cast<std::size_t>(l)] += patch.weight[i] * residual * residual;
      if (!derivatives) continue;
      for (int k = 0; k < parameters; ++k)
        j(k) = derivative[static_cast<std::size_t>(k)].at<double>(row, column);
      result.normal[static_cast<std::size_t>(l)].selfadjointView<Eigen::Lower>().rankUpdate(
          j, patch.weight[i]);
      result.gradient[static_cast<std::size_t>(l)].noalias() += patch.weight[i] * residual * j;
    }
  return result;
}

Vector bounded(Vector p, bool with_front) {
  p(rise) = with_front ? std::clamp(p(rise), -0.2, 2.0) : 0;
  p(interval) = std::clamp(p(interval), narrowest, widest);
  return p;
}

Vector solve(Matrix normal, const Vector& gradient, double damping, bool with_front,
             bool fixed_interval) {
  normal = Matrix(normal.selfadjointView<Eigen::Lower>());
  if (!with_front)
    for (const int k : {theta_star, rise, interval}) {
      normal.row(k).setZero();
      normal.col(k).setZero();
      normal(k, k) = 1;
    }
  if (fixed_interval) {
    normal.row(interval).setZero();
    normal.col(interval).setZero();
    normal(interval, interval) = 1;
  }
  const double trace = normal.diagonal().maxCoeff();
  for (int k = 0; k < parameters; ++k)
    normal(k, k) = normal(k, k) * (1 + damping) + 1e-9 * std::max(1e-6 * trace, normal(k, k));
  Vector g = gradient;
  if (!with_front) g(theta_star) = g(rise) = 0;
  if (!with_front || fixed_interval) g(interval) = 0;
  return normal.ldlt().solve(g);
}

Vector minimise(const Patch& patch, Vector p, bool with_front, int steps) {
  double damping = 1e-2;
  p = bounded(p, with_front);
  Linearised at = linearise(patch, p, true);
  double chi = at.total();
  for (int i = 0; i < steps; ++i) {
    const Vector step = solve(sum(at.normal), sum(at.gradient), damping, with_front);
    const Vector next = bounded(p + step, with_front);
    const double trial = linearise(patch, next, false).total();
    if (std::isfinite(trial) && trial < chi) {
      const bool done = chi - trial < 1e-3 * (1 + 1e-3 * chi);
      p = next;
      chi = trial;
      damping = std::max(damping * 0.2, 1e-9);
      if (done) break;
      at = linearise(patch, p, true);
    } else {
      damping *= 8;
      if (damping > 1e6) break;
    }
  }
  return p;
}

Vector first_guess(const Patch& patch, double height, double width) {
  constexpr double slope = 0.15;  // of theta a pixel, typical of a tail
  Eigen::Matrix<double, terms, terms> normal = Eigen::Matrix<double, terms, terms>::Zero();
  Eigen::Matrix<double, terms, 1> right = Eigen::Matrix<double, terms, 1>::Zero();
  Eigen::Matrix<double, terms, 1> b;
  for (int l = 0; l < patch.lines; ++l)
    for (int c = 0; c < patch.columns; ++c) {
      const auto i = static_cast<std::size_t>(l * patch.columns + c);
      if (patch.weight[i] == 0) continue;
      const double behind =
          (patch.crossing[static_cast<std::size_t>(l)] - c) / static_cast<double>(Stack::samples);
      const double ramp = height * std::clamp(behind * slope / width, 0.0, 1.0);
      basis(patch, patch.x(c + patch.margin_columns),
            patch.y(patch.margin_rows + l * fine + fine / 2), b.data());
      const double weight = std::min(patch.weight[i] * patch.smooth[i] * patch.smooth[i], 1e4);
      normal += weight * b * b.transpose();
      right += weight * (std::log(patch.smooth[i]) - ramp) * b;
    }
  for (int k = 0; k < terms; ++k) normal(k, k) = normal(k, k) * (1 + 1e-6) + 1e-9;
  Vector p = Vector::Zero();
  p.head<terms>() = normal.ldlt().solve(right);
  p(rise) = height;
  p(interval) = width;
  for (int l = 0; l < patch.lines; ++l)
    p(theta_star) +=
        theta_at(patch, p,
                 patch.x(patch.crossing[static_cast<std::size_t>(l)] + patch.margin_columns),
                 patch.y(patch.margin_rows + l * fine + fine / 2)) /
        patch.lines;
  return p;
}

std::optional<Place> outermost(const Patch& patch, const Vector& p, const PlateEdge& edge,
                               double level) {
  std::optional<Place> place;
  for (int r = patch.margin_rows; r < patch.height() - patch.margin_rows; ++r) {
    if (edge.present && patch.row(r) < edge.row - 0.17) continue;
    const double y = patch.y(r);
    double inner = patch.x(patch.width() - patch.margin_columns - 1);
    const double last = patch.x(patch.margin_columns), step = 0.25 / patch.scale;
    if (theta_at(patch, p, inner, y) < level) continue;
    double outer = inner;
    while (outer > last && theta_at(patch, p, outer, y) >= level) outer -= step;
    if (outer <= last) continue;
    inner = outer + step;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (inner + outer);
      (theta_at(patch, p, middle, y) >= level ? inner : outer) = middle;
    }
    if (!place || inner < place->x) place = Place{inner, patch.row(r)};
  }
  return place;
}

double along_line(const Patch& patch, const Place& place) {
  return (place.x * patch.scale * Stack::samples + patch.centre_column) / Stack::samples;
}

}  // namespace meltproof::imaging::blurred_fit

// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/tail_model.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <Eigen/Dense>
#include <gsl/gsl_rng.h>
#include <opencv2/imgproc.hpp>

namespace meltproof::imaging {
namespace {

constexpr int along_order = 4, across_order = 4;  // of the polynomial
constexpr int terms = (along_order + 1) * (across_order + 1);
constexpr int parameters = terms + 3;
constexpr int theta_star = terms, rise = terms + 1, interval = terms + 2;
constexpr int fine = 3;            // rows of the model a line: the front bends within a pixel
constexpr double softness = 0.03;  // of theta, rounds the corners of F by a quarter of a pixel
constexpr double reach = 7;        // px along a line on either side of the start
constexpr double narrowest = 0.02, widest = 1.2;  // interval of theta
constexpr double scale = 6;        // px, makes the polynomial's arguments of order one

using Vector = Eigen::Matrix<double, parameters, 1>;
using Matrix = Eigen::Matrix<double, parameters, parameters>;

double softplus(double x) { return x > 30 ? x : std::log1p(std::exp(x)); }
double logistic(double x) { return 1 / (1 + std::exp(-x)); }

/// The part of the stack that is fitted, and the model's own finer grid around it.
struct Patch {
  std::size_t column = 0, line = 0;  // of the stack, first
  int columns = 0, lines = 0;
  int margin_columns = 0, margin_rows = 0;
  double centre_column = 0, centre_line = 0;
  double highest = 0;                    // ln S that the polynomial may reach in the margins
  cv::Mat along, across;                 // kernels
  std::vector<double> value, weight;     // lines * columns; weight 0: not compared
  std::vector<int> crossing;             // of every line, column where it falls to the start
  std::vector<double> mask;              // of every row of the model: part of it that is metal

  int width() const { return columns + 2 * margin_columns; }
  int height() const { return lines * fine + 2 * margin_rows; }
  double x(int model_column) const {
    return (static_cast<double>(column) + model_column - margin_columns - centre_column) /
           Stack::samples / scale;
  }
  double row(int model_row) const {  // in lines of the stack
    return static_cast<double>(line) + (model_row - margin_rows - 0.5 * (fine - 1)) / fine;
  }
  double y(int model_row) const { return (row(model_row) - centre_line) / scale; }
};

cv::Mat gaussian(double sigma) {
  return cv::getGaussianKernel(2 * static_cast<int>(std::ceil(4 * sigma)) + 1, sigma, CV_64F);
}

void basis(double x, double y, double* out) {
  double px = 1;
  for (int i = 0; i <= along_order; ++i, px *= x) {
    double py = px;
    for (int j = 0; j <= across_order; ++j, py *= y) *out++ = py;
  }
}

double theta_at(const Vector& p, double x, double y) {
  double b[terms], theta = 0;
  basis(x, y, b);
  for (int k = 0; k < terms; ++k) theta += p(k) * b[k];
  return theta;
}

/// The part of the stack within reach of the place where each line falls to `start`.
std::optional<Patch> make_patch(const Stack& stack, double dark, const Blur& blur,
                                const PlateEdge& edge, double start) {
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
    while (tail > 0 && static_cast<double>(v[tail]) - dark > 0.8 * (static_cast<double>(v[peak]) - dark))
      --tail;
  }
  if (tip < 0) return std::nullopt;
  const auto r = static_cast<std::ptrdiff_t>(reach * Stack::samples);
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
                       to = std::min(lowest + r, tail);
  if (to - from < 8 * static_cast<std::ptrdiff_t>(Stack::samples)) return std::nullopt;
  if (to - lowest < 2 * static_cast<std::ptrdiff_t>(Stack::samples)) return std::nullopt;
  Patch patch;
  patch.highest = start + 4;
  patch.column = static_cast<std::size_t>(from);
  patch.columns = static_cast<int>(to - from);
  patch.line = static_cast<std::size_t>(first_line);
  patch.lines = static_cast<int>(last_line - first_line + 1);
  patch.along = gaussian(blur.along * Stack::samples);
  patch.across = gaussian(blur.across * fine);
  patch.margin_columns = patch.along.rows / 2;
  patch.margin_rows = patch.across.rows / 2;
  patch.centre_column = static_cast<double>(lowest);
  patch.centre_line = static_cast<double>(tip);
  for (int row = 0; row < patch.height(); ++row)
    patch.mask.push_back(edge.present
                             ? std::clamp((patch.row(row) - edge.row) * fine + 0.5, 0.0, 1.0)
                             : 1.0);
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
      const bool known = std::isfinite(s) && s > 0.15 * std::exp(start);
      patch.value.push_back(known ? s : 0);
      patch.weight.push_back(known ? 1 / u2 : 0);
      used += known ? 1 : 0;
    }
  if (used < 4 * static_cast<std::size_t>(parameters)) return std::nullopt;
  return patch;
}

/// Model, its derivatives, and what of the normal equations each line gives.
struct Linearised {
  std::vector<Matrix> normal;   // a line
  std::vector<Vector> gradient;
  std::vector<double> chi_squared;
  cv::Mat blurred;              // fine grid
  double total() const {
    double sum = 0;
    for (const double c : chi_squared) sum += c;
    return sum;
  }
};

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
      basis(patch.x(c), patch.y(r), b);
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
      result.normal[static_cast<std::size_t>(l)]
          .selfadjointView<Eigen::Lower>()
          .rankUpdate(j, patch.weight[i]);
      result.gradient[static_cast<std::size_t>(l)].noalias() += patch.weight[i] * residual * j;
    }
  return result;
}

Vector bounded(Vector p, bool with_front) {
  p(rise) = with_front ? std::clamp(p(rise), -0.2, 2.0) : 0;
  p(interval) = std::clamp(p(interval), narrowest, widest);
  return p;
}

template <class T>
T sum(const std::vector<T>& v) {
  T total = v.front();
  for (std::size_t i = 1; i < v.size(); ++i) total += v[i];
  return total;
}

Vector solve(Matrix normal, const Vector& gradient, double damping, bool with_front,
             bool fixed_interval = false) {
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

/// Levenberg and Marquardt.
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

/// Where the fit begins: a front of this height and interval where every line falls to the start,
/// and the polynomial through what is left of ln S.
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
      basis(patch.x(c + patch.margin_columns), patch.y(patch.margin_rows + l * fine + fine / 2),
            b.data());
      normal += b * b.transpose();
      right += (std::log(patch.value[i]) - ramp) * b;
    }
  for (int k = 0; k < terms; ++k) normal(k, k) *= 1 + 1e-6;
  Vector p = Vector::Zero();
  p.head<terms>() = normal.ldlt().solve(right);
  p(rise) = height;
  p(interval) = width;
  for (int l = 0; l < patch.lines; ++l)
    p(theta_star) +=
        theta_at(p, patch.x(patch.crossing[static_cast<std::size_t>(l)] + patch.margin_columns),
                 patch.y(patch.margin_rows + l * fine + fine / 2)) /
        patch.lines;
  return p;
}

struct Place {
  double x = 0, row = 0;  // the polynomial's argument; line
};

/// Outermost place where theta falls to theta*, over the patch's own rows.
std::optional<Place> outermost(const Patch& patch, const Vector& p, const PlateEdge& edge) {
  std::optional<Place> place;
  for (int r = patch.margin_rows; r < patch.height() - patch.margin_rows; ++r) {
    if (edge.present && patch.row(r) < edge.row - 0.17) continue;
    const double y = patch.y(r);
    double inner = patch.x(patch.width() - patch.margin_columns - 1);
    const double last = patch.x(patch.margin_columns), step = 0.25 / scale;
    if (theta_at(p, inner, y) < p(theta_star)) continue;
    double outer = inner;
    while (outer > last && theta_at(p, outer, y) >= p(theta_star)) outer -= step;
    if (outer <= last) continue;
    inner = outer + step;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (inner + outer);
      (theta_at(p, middle, y) >= p(theta_star) ? inner : outer) = middle;
    }
    if (!place || inner < place->x) place = Place{inner, patch.row(r)};
  }
  return place;
}

}  // namespace

Blur total_blur(double point_spread, double shift) {
  const double across = point_spread * point_spread + 1.0 / 12;
  return {std::sqrt(across + shift * shift / 12), std::sqrt(across)};
}

std::optional<TailModel> fit_tail(const Stack& stack, double dark, const Blur& blur,
                                  const PlateEdge& edge, double start, std::uint64_t seed,
                                  int steps) {
  const double column = 1.0 / (12 * Stack::samples * Stack::samples);
  const Blur whole{std::sqrt(blur.along * blur.along + column), blur.across};
  const auto patch = make_patch(stack, dark, whole, edge, start);
  if (!patch) return std::nullopt;
  const Vector smooth = minimise(*patch, first_guess(*patch, 0, 0.1), false, 25);
  const double chi_smooth = linearise(*patch, smooth, false).total();
  // A step and a shoulder, both as a fit may start; the better one is kept.
  Vector best = smooth;
  double chi = 1e300;
  for (const auto& [height, width] : {std::pair{0.4, 0.08}, {0.5, 0.55}, {0.8, 0.5}}) {
    Vector p = first_guess(*patch, height, width);
    p = minimise(*patch, p, true, steps);
    const double trial = linearise(*patch, p, false).total();
    if (trial < chi) chi = trial, best = p;
  }
  const auto place = outermost(*patch, best, edge);
  if (!place) return std::nullopt;
  const Linearised at = linearise(*patch, best, true);
  const Linearised without = linearise(*patch, smooth, false);
  std::size_t used = 0;
  for (const double w : patch->weight) used += w > 0 ? 1 : 0;

  TailModel model;
  model.log_signal = best(theta_star);
  model.rise = best(rise);
  model.interval = best(interval);
  const auto along_line = [&](const Place& at_place) {
    return (at_place.x * scale * Stack::samples + patch->centre_column) / Stack::samples;
  };
  model.front = along_line(*place);
  const double y = (place->row - patch->centre_line) / scale;
  model.slope = (theta_at(best, place->x, y) - theta_at(best, place->x + 0.1 / scale, y)) / 0.1;
  const int c = static_cast<int>(std::lround(place->x * scale * Stack::samples + patch->centre_column -
                                             static_cast<double>(patch->column))) +
                patch->margin_columns;
  const int r = static_cast<int>(std::lround((place->row - static_cast<double>(patch->line)) * fine +
                                             0.5 * (fine - 1))) +
                patch->margin_rows;
  model.blurred = std::log(std::max(at.blurred.at<double>(r, c), 1e-12));
  model.misfit = std::max(1.0, chi / static_cast<double>(used - parameters));
  model.explained = (chi_smooth - chi) / model.misfit;
  for (int l = 0; l < patch->lines; ++l) {
    const auto i = static_cast<std::size_t>(l);
    model.lines += 1;
    if ((without.chi_squared[i] - at.chi_squared[i]) / model.misfit >= 25)
      model.lines_with_front += 1;
  }
  // One step of Gauss and Newton with the lines drawn with replacement.
  const std::unique_ptr<gsl_rng, decltype(&gsl_rng_free)> random(gsl_rng_alloc(gsl_rng_mt19937),
                                                                 &gsl_rng_free);
  gsl_rng_set(random.get(), static_cast<unsigned long>(seed));
  std::vector<double> signals, rises, fronts;
  const bool at_bound = best(interval) < 1.5 * narrowest || best(interval) >= widest;
  const auto lines = static_cast<unsigned long>(patch->lines);
  for (int draw = 0; draw < 200; ++draw) {
    Matrix normal = 1e-3 * sum(at.normal);  // a draw may lack the lines that fix a term
    Vector gradient = 1e-3 * sum(at.gradient);
    for (unsigned long l = 0; l < lines; ++l) {
      const auto i = static_cast<std::size_t>(gsl_rng_uniform_int(random.get(), lines));
      normal += at.normal[i];
      gradient += at.gradient[i];
    }
    const Vector p = bounded(best + solve(normal, gradient, 1e-6, true, at_bound), true);
    const auto drawn = outermost(*patch, p, edge);
    if (!drawn) continue;
    signals.push_back(p(theta_star));
    rises.push_back(p(rise));
    fronts.push_back(along_line(*drawn));
  }
  // Robust, since one linear step may leave the range where it is one.
  const auto spread = [](std::vector<double> v) {
    if (v.size() < 20) return 1e9;
    std::sort(v.begin(), v.end());
    const auto at_part = [&](double q) { return v[static_cast<std::size_t>(q * static_cast<double>(v.size() - 1))]; };
    return 0.5 * (at_part(0.8413) - at_part(0.1587));
  };
  model.u_log_signal = spread(signals);
  model.u_rise = spread(rises);
  model.u_front = spread(fronts);
  return model;
}

}  // namespace meltproof::imaging

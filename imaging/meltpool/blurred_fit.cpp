// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/blurred_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace meltproof::imaging::blurred_fit {
namespace {

using Image = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The blur from the model's grid to the samples along one axis, samples in columns, and its change
/// with its variance.
struct Kernel {
  Image weight, by_variance;
};
/// @param spacing of the grid, px; @param middle grid point of every sample.
Kernel gaussian(double v, double spacing, int points, const std::vector<int>& middle, int reach) {
  Kernel k;
  const auto samples = static_cast<Eigen::Index>(middle.size());
  k.weight = k.by_variance = Image::Zero(points, samples);
  for (Eigen::Index s = 0; s < samples; ++s) {
    const int m = middle[static_cast<std::size_t>(s)];
    const int first = std::max(0, m - reach), last = std::min(points - 1, m + reach);
    double sum = 0, mean = 0;
    for (int i = first; i <= last; ++i) {
      const double d2 = std::pow((i - m) * spacing, 2), g = std::exp(-0.5 * d2 / v);
      k.weight(i, s) = g;
      sum += g;
      mean += g * d2;
    }
    mean /= sum;
    for (int i = first; i <= last; ++i) {
      k.weight(i, s) /= sum;
      k.by_variance(i, s) = k.weight(i, s) * (std::pow((i - m) * spacing, 2) - mean) / (2 * v * v);
    }
  }
  return k;
}

}  // namespace

Field field_at(const Patch& patch, const Vector& p, double x, double y) {
  Field f;
  // Horner's scheme within Horner's scheme.
  for (int i = along_order; i >= 0; --i) {
    double v = 0, by_y = 0;
    for (int j = across_order; j >= 0; --j) {
      by_y = by_y * y + v;
      v = v * y + (has_term(patch, j) ? p(i * (across_order + 1) + j) : 0);
    }
    f.by_x = f.by_x * x + f.theta;
    f.theta = f.theta * x + v;
    f.by_y = f.by_y * x + by_y;
  }
  return f;
}

Vector terms_at(const Patch& patch, double x, double y) {
  Vector by = Vector::Zero();
  for (int k = 0; k < terms; ++k) {
    const int power = k % (across_order + 1);
    if (has_term(patch, power)) by(k) = std::pow(x, k / (across_order + 1)) * std::pow(y, power);
  }
  return by;
}

TailLaw law_of(const Patch& patch, const Vector& p) {
  return {p(theta_star), p(ratio), p(interval), patch.steepness};
}

double Linearised::total() const {
  double sum = prior;
  for (const double c : chi_squared) sum += c;
  return sum;
}

Linearised linearise(const Patch& patch, const Vector& p, bool derivatives) {
  const int w = patch.width(), h = patch.height();
  const TailLaw law = law_of(patch, p);
  const double dx = 1 / (Stack::samples * patch.scale), dy = 1 / (fine * patch.scale);
  Image signal(h, w);
  std::array<Image, 5> by;  // theta, theta*, ratio, interval, cap
  if (derivatives)
    for (auto& m : by) m.resize(h, w);
  for (int r = 0; r < h; ++r) {
    const double metal = patch.mask[static_cast<std::size_t>(r)], y = patch.y(patch.row(r));
    for (int c = 0; c < w; ++c) {
      const Field f = field_at(patch, p, patch.x(c), y);
      const double cell = std::hypot(f.by_x * dx, f.by_y * dy);
      const TailLawValue v = tail_law(law, f.theta, cell);
      const bool capped = v.log_signal > p(cap);
      const double s = metal * std::exp(std::min(v.log_signal, p(cap)));
      signal(r, c) = s;
      if (!derivatives) continue;
      by[4](r, c) = capped ? s : 0;
      const double below = capped ? 0 : s;
      by[0](r, c) = below * v.by_theta;
      by[1](r, c) = below * v.by_theta_star;
      by[2](r, c) = below * v.by_ratio;
      by[3](r, c) = below * v.by_interval;
    }
  }
  std::vector<int> columns, rows;
  for (int c = 0; c < patch.columns; ++c) columns.push_back(c + patch.margin_columns);
  for (int l = 0; l < patch.lines; ++l) rows.push_back(patch.middle(l));
  const Eigen::Vector2d v = patch.variances(p(variance));
  const Kernel along = gaussian(v(0), 1.0 / Stack::samples, w, columns, patch.margin_columns);
  const Kernel across = gaussian(v(1), 1.0 / fine, h, rows, patch.margin_rows);
  const auto blurred = [&](const Image& m) -> Image {
    return (across.weight.transpose() * m) * along.weight;
  };
  const Image model = blurred(signal);

  Linearised result;
  result.blurred.assign(model.data(), model.data() + model.size());
  const auto lines = static_cast<std::size_t>(patch.lines);
  result.chi_squared.assign(lines, 0);
  const Vector off = p - patch.prior.mean;
  result.prior = off.dot(patch.prior.weight.cwiseProduct(off));
  const auto samples = static_cast<std::size_t>(patch.lines * patch.columns);
  for (std::size_t i = 0; i < samples; ++i)
    result.chi_squared[i / static_cast<std::size_t>(patch.columns)] +=
        patch.weight[i] * std::pow(patch.value[i] - result.blurred[i], 2);
  if (!derivatives) return result;

  std::array<Image, parameters> derivative;
  Eigen::VectorXd power_y(h), power_x(w);
  for (int j = 0; j <= across_order; ++j) {
    for (int r = 0; r < h; ++r) power_y(r) = std::pow(patch.y(patch.row(r)), j);
    const Image part = (power_y.asDiagonal() * across.weight).transpose() * by[0];
    for (int i = 0; i <= along_order; ++i) {
      auto& d = derivative[static_cast<std::size_t>(i * (across_order + 1) + j)];
      if (!has_term(patch, j)) {
        d = Image::Zero(patch.lines, patch.columns);
        continue;
      }
      for (int c = 0; c < w; ++c) power_x(c) = std::pow(patch.x(c), i);
      d = part * (power_x.asDiagonal() * along.weight);
    }
  }
  derivative[theta_star] = blurred(by[1]);
  derivative[ratio] = blurred(by[2]);
  derivative[interval] = blurred(by[3]);
  derivative[cap] = blurred(by[4]);
  derivative[variance] = (across.by_variance.transpose() * signal) * along.weight +
                         (across.weight.transpose() * signal) * along.by_variance;
  result.normal.assign(lines, Matrix::Zero());
  result.gradient.assign(lines, Vector::Zero());
  Eigen::Matrix<double, Eigen::Dynamic, parameters> j(patch.columns, int{parameters});
  Eigen::VectorXd residual(patch.columns);
  for (int l = 0; l < patch.lines; ++l) {
    for (int c = 0; c < patch.columns; ++c) {
      const auto i = static_cast<std::size_t>(l * patch.columns + c);
      const double root = std::sqrt(patch.weight[i]);
      residual(c) = root * (patch.value[i] - result.blurred[i]);
      for (int k = 0; k < parameters; ++k)
        j(c, k) = root * derivative[static_cast<std::size_t>(k)](l, c);
    }
    result.normal[static_cast<std::size_t>(l)].selfadjointView<Eigen::Lower>().rankUpdate(
        j.transpose());
    result.gradient[static_cast<std::size_t>(l)].noalias() = j.transpose() * residual;
  }
  return result;
}

double blurred_log_signal(const Patch& patch, const Vector& p, double x, double stack_line) {
  const TailLaw law = law_of(patch, p);
  const Eigen::Vector2d v = patch.variances(p(variance));
  constexpr int half = 20;  // points on either side
  const double u = 3.5 * std::sqrt(v(0)) / half, t = 3.5 * std::sqrt(v(1)) / half;
  double sum = 0, weight = 0;
  for (int i = -half; i <= half; ++i)
    for (int k = -half; k <= half; ++k) {
      const Field f = field_at(patch, p, x + i * u / patch.scale, patch.y(stack_line + k * t));
      const double g = std::exp(-0.5 * (i * i * u * u / v(0) + k * k * t * t / v(1)));
      const double cell = std::hypot(f.by_x * u, f.by_y * t) / patch.scale;
      sum += g * std::exp(std::min(tail_law(law, f.theta, cell).log_signal, p(cap)));
      weight += g;
    }
  return std::log(sum / weight);
}

Vector first_guess(const Patch& patch, const TailLaw& law) {
  constexpr double slope = 0.15;  // of theta a pixel, typical of a tail
  Eigen::Matrix<double, terms, terms> normal = Eigen::Matrix<double, terms, terms>::Zero();
  Eigen::Matrix<double, terms, 1> right = Eigen::Matrix<double, terms, 1>::Zero();
  Eigen::Matrix<double, terms, 1> b;
  const double width = std::max(law.interval, 0.08);
  for (int l = 0; l < patch.lines; ++l)
    for (int c = 0; c < patch.columns; ++c) {
      const auto i = static_cast<std::size_t>(l * patch.columns + c);
      if (patch.weight[i] == 0) continue;
      double ramp = 0;
      if (!patch.crossing.empty()) {
        const double behind =
            (patch.crossing[static_cast<std::size_t>(l)] - c) / static_cast<double>(Stack::samples);
        ramp = law.rise() * std::clamp(behind * slope / width, 0.0, 1.0);
      }
      const double x = patch.x(c + patch.margin_columns), y = patch.y(patch.row(patch.middle(l)));
      for (int k = 0; k < terms; ++k) {
        const int power = k % (across_order + 1);
        b(k) =
            has_term(patch, power) ? std::pow(x, k / (across_order + 1)) * std::pow(y, power) : 0.0;
      }
      const double weight = std::min(patch.weight[i] * patch.smooth[i] * patch.smooth[i], 1e4);
      normal += weight * b * b.transpose();
      right += weight * (std::log(patch.smooth[i]) - ramp) * b;
    }
  for (int k = 0; k < terms; ++k) normal(k, k) = normal(k, k) * (1 + 1e-6) + 1e-9;
  Vector p = Vector::Zero();
  p.head<terms>() = normal.ldlt().solve(right);
  p(ratio) = law.ratio;
  p(interval) = law.interval;
  p(cap) = patch.brightest + 4;
  for (int l = 0; l < patch.lines && !patch.crossing.empty(); ++l)
    p(theta_star) +=
        field_at(patch, p,
                 patch.x(patch.crossing[static_cast<std::size_t>(l)] + patch.margin_columns),
                 patch.y(patch.row(patch.middle(l))))
            .theta /
        patch.lines;
  return p;
}

}  // namespace meltproof::imaging::blurred_fit

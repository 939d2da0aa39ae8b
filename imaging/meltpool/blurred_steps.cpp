// SPDX-License-Identifier: GPL-3.0-or-later
// Least squares by steps of Gauss and Newton, with what is known beforehand.
#include <algorithm>
#include <cmath>

#include "imaging/meltpool/blurred_fit.hpp"

namespace meltproof::imaging::blurred_fit {

Vector bounded(const Patch& patch, Vector p, const Freedom& free) {
  if (free.ratio) p(ratio) = std::clamp(p(ratio), -0.5, 2.0);
  if (free.interval) p(interval) = std::clamp(p(interval), patch.narrowest, patch.widest);
  const double least = std::pow(std::min(patch.blur.along, patch.blur.across), 2);
  if (free.cap) p(cap) = std::clamp(p(cap), patch.brightest, patch.brightest + 4);
  p(variance) = std::clamp(p(variance), -0.7 * least, 2 * least);
  return p;
}

namespace {

bool is_free(const Patch& patch, const Freedom& free, int k) {
  switch (k) {
    case theta_star:
      return free.theta_star;
    case ratio:
      return free.ratio;
    case interval:
      return free.interval;
    case variance:
      return free.variance && patch.prior.weight(variance) > 0;
    case cap:
      return free.cap;
    default:
      return has_term(patch, k % (across_order + 1));
  }
}

/// The normal equations with what is known beforehand, both halves, rows of parameters that are
/// not free those of the unit matrix.
Matrix with_prior(const Patch& patch, const Matrix& lower, const Freedom& free) {
  Matrix normal = Matrix(lower.selfadjointView<Eigen::Lower>());
  normal.diagonal() += patch.prior.weight;
  for (int k = 0; k < parameters; ++k) {
    if (is_free(patch, free, k)) continue;
    normal.row(k).setZero();
    normal.col(k).setZero();
    normal(k, k) = 1;
  }
  return normal;
}

}  // namespace

Vector solve(const Patch& patch, Matrix normal, Vector gradient, const Vector& p, double damping,
             const Freedom& free) {
  normal = with_prior(patch, normal, free);
  gradient += patch.prior.weight.cwiseProduct(patch.prior.mean - p);
  for (int k = 0; k < parameters; ++k)
    if (!is_free(patch, free, k)) gradient(k) = 0;
  const double trace = normal.diagonal().maxCoeff();
  for (int k = 0; k < parameters; ++k)
    normal(k, k) = normal(k, k) * (1 + damping) + 1e-9 * std::max(1e-6 * trace, normal(k, k));
  return normal.ldlt().solve(gradient);
}

Matrix covariance(const Patch& patch, const Linearised& at, const Freedom& free) {
  Matrix c = with_prior(patch, sum(at.normal), free).ldlt().solve(Matrix::Identity());
  for (int k = 0; k < parameters; ++k)
    if (!is_free(patch, free, k)) c(k, k) = 0;
  return c;
}

Vector response(const Patch& patch, const Linearised& at, const Freedom& free, int parameter) {
  const Matrix all = Matrix(sum(at.normal).selfadjointView<Eigen::Lower>());
  Vector right = -all.col(parameter);
  for (int k = 0; k < parameters; ++k)
    if (!is_free(patch, free, k)) right(k) = 0;
  Matrix normal = with_prior(patch, all, free);
  normal.diagonal() += 1e-9 * normal.diagonal();
  normal.diagonal().array() += 1e-15 * normal.diagonal().maxCoeff();
  return normal.ldlt().solve(right);
}

Vector minimise(const Patch& patch, Vector p, const Freedom& free, int steps) {
  double damping = 1e-2;
  p = bounded(patch, p, free);
  Linearised at = linearise(patch, p, true);
  double chi = at.total();
  for (int i = 0; i < steps; ++i) {
    const Vector step = solve(patch, sum(at.normal), sum(at.gradient), p, damping, free);
    const Vector next = bounded(patch, p + step, free);
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

}  // namespace meltproof::imaging::blurred_fit

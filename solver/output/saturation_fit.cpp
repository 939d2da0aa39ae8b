// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/saturation_fit.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit_nlinear.h>

#include "solver/output/steady_state.hpp"

namespace meltproof::solver {
namespace {

/// The series in units of its largest value and its last time, so that both parameters are near 1.
struct Scaled {
  std::vector<double> t, y;
};

/// Parameters: L_inf and ln tau, so that tau stays positive.
int residuals(const gsl_vector* x, void* data, gsl_vector* f) {
  const auto& s = *static_cast<const Scaled*>(data);
  const double limit = gsl_vector_get(x, 0), rate = std::exp(-gsl_vector_get(x, 1));
  for (std::size_t i = 0; i < s.t.size(); ++i) {
    gsl_vector_set(f, i, -limit * std::expm1(-rate * s.t[i]) - s.y[i]);
  }
  return GSL_SUCCESS;
}

int jacobian(const gsl_vector* x, void* data, gsl_matrix* j) {
  const auto& s = *static_cast<const Scaled*>(data);
  const double limit = gsl_vector_get(x, 0), rate = std::exp(-gsl_vector_get(x, 1));
  for (std::size_t i = 0; i < s.t.size(); ++i) {
    gsl_matrix_set(j, i, 0, -std::expm1(-rate * s.t[i]));
    gsl_matrix_set(j, i, 1, -limit * rate * s.t[i] * std::exp(-rate * s.t[i]));
  }
  return GSL_SUCCESS;
}

}  // namespace

SaturationFit fit_saturation(const std::vector<double>& time, const std::vector<double>& value) {
  SaturationFit fit;
  const std::size_t n = time.size();
  if (n < 8) {
    return fit;
  }
  const double t_scale = time.back(), y_scale = *std::max_element(value.begin(), value.end());
  if (!(t_scale > 0) || !(y_scale > 0)) {
    return fit;
  }
  Scaled s{time, value};
  for (std::size_t i = 0; i < n; ++i) {
    s.t[i] /= t_scale;
    s.y[i] /= y_scale;
  }
  gsl_set_error_handler_off();
  gsl_multifit_nlinear_parameters options = gsl_multifit_nlinear_default_parameters();
  const std::unique_ptr<gsl_multifit_nlinear_workspace, decltype(&gsl_multifit_nlinear_free)> w{
      gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &options, n, 2),
      &gsl_multifit_nlinear_free};
  gsl_multifit_nlinear_fdf problem{};
  problem.f = residuals;
  problem.df = jacobian;
  problem.n = n;
  problem.p = 2;
  problem.params = &s;
  double start[2] = {1.1, std::log(0.4)};
  const gsl_vector_view x = gsl_vector_view_array(start, 2);
  int info = 0;
  if (gsl_multifit_nlinear_init(&x.vector, &problem, w.get()) != GSL_SUCCESS ||
      gsl_multifit_nlinear_driver(200, 1e-10, 1e-10, 0, nullptr, nullptr, &info, w.get()) !=
          GSL_SUCCESS) {
    return fit;
  }
  const gsl_vector* best = gsl_multifit_nlinear_position(w.get());
  const gsl_vector* left = gsl_multifit_nlinear_residual(w.get());
  std::vector<double> residual(n);
  double squares = 0;
  for (std::size_t i = 0; i < n; ++i) {
    residual[i] = gsl_vector_get(left, i);
    squares += residual[i] * residual[i];
  }
  fit.effective = effective_size(residual, 2).size;
  if (is_smooth(std::sqrt(squares / static_cast<double>(n)), gsl_vector_get(best, 0))) {
    fit.effective = std::max(fit.effective, least_independent);
  }
  if (fit.effective < least_independent) {
    return fit;
  }
  double c[4] = {};
  gsl_matrix_view covariance = gsl_matrix_view_array(c, 2, 2);
  gsl_multifit_nlinear_covar(gsl_multifit_nlinear_jac(w.get()), 0, &covariance.matrix);
  const double variance = squares / (fit.effective - 2);
  fit.limit = y_scale * gsl_vector_get(best, 0);
  fit.tau = t_scale * std::exp(gsl_vector_get(best, 1));
  fit.u_limit = y_scale * std::sqrt(variance * c[0]);
  fit.u_tau = fit.tau * std::sqrt(variance * c[3]);
  fit.residual = y_scale * std::sqrt(squares / static_cast<double>(n - 2));
  fit.found = std::isfinite(fit.limit) && std::isfinite(fit.u_limit) && fit.limit > 0;
  return fit;
}

}  // namespace meltproof::solver

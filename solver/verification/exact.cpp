// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/verification/exact.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>

namespace meltproof::solver {

double StripeSolution::operator()(double z, double spread) const {
  double sum = 0;
  // Walls without flux: the stripe is mirrored at 0 and at the height, again and again. Erf is flat
  // beyond six spreads, so images further away add nothing.
  const int images = 1 + static_cast<int>(std::ceil(6 * spread / (2 * height)));
  for (int n = -images; n <= images; ++n) {
    const double shift = 2 * height * n;
    sum += std::erf((z - z1 - shift) / spread) - std::erf((z - z2 - shift) / spread);
    sum += std::erf((z + z2 - shift) / spread) - std::erf((z + z1 - shift) / spread);
  }
  return sum / 2;
}

double periodic_stripe(double z, double z1, double z2, double length, double spread) {
  double sum = 0;
  const int images = 1 + static_cast<int>(std::ceil(6 * spread / length));
  for (int n = -images; n <= images; ++n) {
    sum += std::erf((z - z1 - n * length) / spread) - std::erf((z - z2 - n * length) / spread);
  }
  return sum / 2;
}

double printed_stripe(double z, double z1, double z2, double spread) {
  return z <= (z1 + z2) / 2 ? std::erfc((z1 - z) / spread) / 2 : std::erfc((z - z2) / spread) / 2;
}

namespace {

/// The root of a function that changes its sign between low and high.
double root(const std::function<double(double)>& f, double low, double high) {
  gsl_function equation;
  equation.function = [](double x, void* data) {
    return (*static_cast<const std::function<double(double)>*>(data))(x);
  };
  auto function = f;
  equation.params = &function;
  const std::unique_ptr<gsl_root_fsolver, decltype(&gsl_root_fsolver_free)> solver{
      gsl_root_fsolver_alloc(gsl_root_fsolver_brent), &gsl_root_fsolver_free};
  if (gsl_root_fsolver_set(solver.get(), &equation, low, high) != GSL_SUCCESS) {
    throw std::logic_error("an exact solution has no root where it is looked for");
  }
  for (int i = 0; i < 200; ++i) {
    gsl_root_fsolver_iterate(solver.get());
    if (gsl_root_test_interval(gsl_root_fsolver_x_lower(solver.get()),
                               gsl_root_fsolver_x_upper(solver.get()), 0, 1e-14) == GSL_SUCCESS) {
      break;
    }
  }
  return gsl_root_fsolver_root(solver.get());
}

}  // namespace

double stefan_lambda(double stefan) {
  if (!(stefan > 0)) {
    throw std::logic_error("a Stefan number is positive");
  }
  const double target = stefan / std::sqrt(std::numbers::pi);
  return root(
      [&](double lambda) { return lambda * std::exp(lambda * lambda) * std::erf(lambda) - target; },
      1e-8, 5.0);
}

double neumann_lambda(double stefan, double superheat, double conductivity_ratio) {
  const double ratio = std::sqrt(conductivity_ratio);
  return root(
      [&](double l) {
        const double wall = std::exp(-l * l) / std::erf(l);
        const double far =
            superheat * ratio * std::exp(-l * l / (ratio * ratio)) / std::erfc(l / ratio);
        return stefan * (wall - far) - l * std::sqrt(std::numbers::pi);
      },
      1e-8, 5.0);
}

double NeumannSolution::operator()(double x, double time) const {
  const double near = 2 * std::sqrt(diffusivity_wall * time);
  if (x < lambda * near) {
    return wall + (melting - wall) * std::erf(x / near) / std::erf(lambda);
  }
  return far + (melting - far) * std::erfc(x / (2 * std::sqrt(diffusivity_far * time))) /
                   std::erfc(lambda * std::sqrt(diffusivity_wall / diffusivity_far));
}

double stefan_temperature(double x, double time, double diffusivity, double lambda, double wall,
                          double melting) {
  const double spread = 2 * std::sqrt(diffusivity * time);
  return x >= lambda * spread ? melting
                              : wall - (wall - melting) * std::erf(x / spread) / std::erf(lambda);
}

double ContactSolution::operator()(double x, double time) const {
  const double effusivity_left = conductivity_left / std::sqrt(diffusivity_left);
  const double effusivity_right = conductivity_right / std::sqrt(diffusivity_right);
  const double contact =
      (effusivity_left * temperature_left + effusivity_right * temperature_right) /
      (effusivity_left + effusivity_right);
  return x < 0 ? contact + (temperature_left - contact) *
                               std::erf(-x / (2 * std::sqrt(diffusivity_left * time)))
               : contact + (temperature_right - contact) *
                               std::erf(x / (2 * std::sqrt(diffusivity_right * time)));
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/tail_law.hpp"

#include <algorithm>
#include <cmath>

#include <gsl/gsl_sf_lambert.h>

namespace meltproof::imaging {
namespace {

/// clamp(z / width, 0, 1), its integral from -infinity, and that integral's change with `width`.
struct Ramp {
  double value, integral, by_width;
};
Ramp ramp(double z, double width) {
  if (z <= 0) return {0, 0, 0};
  if (z < width) return {z / width, 0.5 * z * z / width, -0.5 * z * z / (width * width)};
  return {1, z - 0.5 * width, -0.5};
}

}  // namespace

Steepness::Steepness(double by_log_temperature) : value_(by_log_temperature) {
  // x / (1 - exp(-x)) = B, solved by Lambert's function.
  const double b = std::max(by_log_temperature, 1.02);
  x_ = b + gsl_sf_lambert_W0(-b * std::exp(-b));
  exp_x_less_1_ = std::expm1(x_);
}

/// Of ln S below theta*: beyond it nothing is left of the signal, and its numbers stay finite.
constexpr double darkest = 100;

TailLawValue tail_law(const TailLaw& law, double theta, double cell) {
  const double b = law.steepness, x = law.steepness.x(), black = law.steepness.exp_x_less_1();
  const double above = theta - law.log_signal;
  if (above > 0.5 * b || (law.ratio == 0 && law.interval == 0)) return {.log_signal = theta};
  // exp(x / tau) - 1; ahead of the beam theta falls without end, and what is so cold is dark.
  const double dim = black * std::exp(std::min(-above, darkest));
  const double liquid = x / std::log1p(dim);  // tau
  const double tau_theta = liquid * liquid / x * dim / (1 + dim);
  const double q = 1 - liquid;
  const double cell_q = std::max(cell * tau_theta, 1e-9);
  if (q <= -0.5 * cell_q) return {.log_signal = theta};
  const double width = law.interval / b;
  const Ramp far = ramp(q + 0.5 * cell_q, width), near = ramp(q - 0.5 * cell_q, width);
  const double f = (far.integral - near.integral) / cell_q;
  const double f_q = (far.value - near.value) / cell_q;
  const double f_width = (far.by_width - near.by_width) / cell_q;
  const double latent = (1 - TailLaw::sensible) * width;
  const double tau = liquid + latent * f, dim_now = std::expm1(x / tau);
  const double by_tau = x / (tau * tau) * (1 + 1 / dim_now);  // of ln S
  const double brighter = std::expm1(law.ratio), mixed = 1 + f * brighter;
  const double by_f = brighter / mixed;
  TailLawValue value;
  value.log_signal = law.log_signal + std::log(black * mixed / dim_now);
  const double by_q = by_tau * (latent * f_q - 1) + by_f * f_q;
  value.by_theta = -by_q * tau_theta;
  value.by_theta_star = 1 - value.by_theta;
  value.by_ratio = f * (1 + brighter) / mixed;
  value.by_interval =
      (by_tau * ((1 - TailLaw::sensible) * f + latent * f_width) + by_f * f_width) / b;
  return value;
}

}  // namespace meltproof::imaging

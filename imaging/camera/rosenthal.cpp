// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/camera/rosenthal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.hpp"

namespace meltproof::imaging {
namespace {

/// Zero of a decreasing function between two points, to the last digit.
template <class F>
double bisect(const F& f, double low, double high) {
  for (int i = 0; i < 200 && high - low > 0; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (f(middle) > 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double rosenthal_temperature(const RosenthalSettings& s, double xi, double y, double z) {
  const double r = std::sqrt(xi * xi + y * y + z * z);
  return s.initial_temperature + s.absorbed_power / (2 * std::numbers::pi * s.conductivity * r) *
                                     std::exp(-s.scan_speed * (xi + r) / (2 * s.diffusivity));
}

RosenthalPool rosenthal_pool(const RosenthalSettings& s) {
  const double rise = s.reference_temperature - s.initial_temperature;
  if (!(rise > 0))
    throw InputError(
        "rosenthal.reference_temperature must be above rosenthal.initial_temperature.");
  // Behind the source the exponential is one.
  const double tail = s.absorbed_power / (2 * std::numbers::pi * s.conductivity * rise);
  const double ahead =
      bisect([&](double r) { return rosenthal_temperature(s, r, 0, 0) - s.reference_temperature; },
             0, tail);
  // On the isotherm xi(R) = -R - b ln(R / tail), b = 2 alpha / v; y^2 = R^2 - xi^2 is largest where
  // R + xi (1 + b / R) = 0, which falls from ahead of the widest place to behind it.
  const double b = 2 * s.diffusivity / s.scan_speed;
  const auto xi = [&](double r) { return -r - b * std::log(r / tail); };
  const double widest = bisect([&](double r) { return r + xi(r) * (1 + b / r); }, ahead, tail);
  return {tail + ahead, 2 * std::sqrt(widest * widest - xi(widest) * xi(widest))};
}

std::function<RayHit(double, double)> rosenthal_field(const RosenthalSettings& source,
                                                      const CameraSettings& camera,
                                                      double position) {
  const bool side = source.view == "side";
  const double liquid = camera.emissivity_liquid, solid = camera.emissivity_solid;
  return [=](double u, double v) -> RayHit {
    if (side && v > 0) return {std::numeric_limits<double>::quiet_NaN(), 1};
    const double t = std::min(side ? rosenthal_temperature(source, u - position, 0, v)
                                   : rosenthal_temperature(source, u - position, v, 0),
                              source.peak_temperature);
    return {t, t >= source.reference_temperature ? liquid : solid};
  };
}

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/radiometry/radiometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>

#include "base/error.hpp"
#include "base/units.hpp"
#include "imaging/radiometry/planck.hpp"

namespace meltproof::imaging {
namespace {

// Exact by definition of the SI (2019).
constexpr double planck = 6.62607015e-34;    // J s
constexpr double light_speed = 299792458.0;  // m s-1
constexpr double boltzmann = 1.380649e-23;   // J K-1
constexpr double first_radiation_constant = 2 * planck * light_speed * light_speed;
constexpr double second_radiation_constant = planck * light_speed / boltzmann;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The integrand of the band, and of its derivative with respect to 1/T.
struct Spectral {
  double inverse_temperature;
  bool derivative;
};

double spectral(double wavelength, void* data) {
  const auto& s = *static_cast<const Spectral*>(data);
  const double c = second_radiation_constant / wavelength;
  const double l = planck_radiance(wavelength, s.inverse_temperature);
  return s.derivative ? c * l / std::expm1(-c * s.inverse_temperature) : l;
}

double integrate(double lower, double upper, double inverse_temperature, bool derivative) {
  if (!(lower > 0 && upper > lower))
    throw InputError("The wavelength band from " + shortest(lower) + " m to " + shortest(upper) +
                     " m is empty; give a lower limit above zero and an upper limit above it.");
  constexpr std::size_t intervals = 200;
  static thread_local const std::unique_ptr<gsl_integration_workspace,
                                            decltype(&gsl_integration_workspace_free)>
      workspace(gsl_integration_workspace_alloc(intervals), &gsl_integration_workspace_free);
  Spectral s{inverse_temperature, derivative};
  gsl_function f{&spectral, &s};
  double result = 0, error = 0;
  // GSL's own handler aborts; it is global, so it is switched off once and for all threads.
  [[maybe_unused]] static gsl_error_handler_t* const previous = gsl_set_error_handler_off();
  const int status = gsl_integration_qag(&f, lower, upper, 0, 1e-12, intervals, GSL_INTEG_GAUSS31,
                                         workspace.get(), &result, &error);
  // Round-off keeps the estimate above the bound for extremely cold bodies; the value is then as
  // good as a double can be.
  if (status != GSL_SUCCESS && status != GSL_EROUND &&
      !(std::abs(error) <= 1e-9 * std::abs(result)))
    throw std::runtime_error("The quadrature of Planck's law did not converge.");
  return result;
}

double radiance_of(const Radiometry& r, double temperature) {
  return r.spectrum ? weighted_radiance(*r.spectrum, temperature)
                    : band_radiance(r.band_lower, r.band_upper, temperature);
}

double window_radiance(const Radiometry& r, double radiance_of_window) {
  return r.window_emission ? (1 - r.transmission) * radiance_of_window : 0.0;
}

double to_signal(const Radiometry& r, double emissivity, double surface, double ambient,
                 double window) {
  const double seen = r.transmission * (emissivity * surface + (1 - emissivity) * ambient) +
                      window_radiance(r, window);
  return r.gain * r.integration_time * seen + r.dark;
}

double to_surface_radiance(const Radiometry& r, double signal, double ambient, double window) {
  if (!(r.gain > 0 && r.integration_time > 0 && r.transmission > 0 && r.emissivity > 0))
    throw InputError("A signal can only be turned into a temperature with a positive gain (found " +
                     shortest(r.gain) + "), integration time (" + shortest(r.integration_time) +
                     " s), transmission (" + shortest(r.transmission) + ") and emissivity (" +
                     shortest(r.emissivity) + ").");
  const double seen = (signal - r.dark) / (r.gain * r.integration_time);
  return ((seen - window_radiance(r, window)) / r.transmission - (1 - r.emissivity) * ambient) /
         r.emissivity;
}

}  // namespace

double planck_radiance(double wavelength, double inverse_temperature) {
  // Written with exp(-x), so that a cold body underflows to zero.
  const double x = second_radiation_constant / wavelength * inverse_temperature;
  return first_radiation_constant /
         (wavelength * wavelength * wavelength * wavelength * wavelength) * std::exp(-x) /
         -std::expm1(-x);
}

double planck_integral(double lower, double upper, double inverse_temperature,
                       const std::function<double(double)>& weight) {
  static const std::unique_ptr<gsl_integration_glfixed_table,
                               decltype(&gsl_integration_glfixed_table_free)>
      table(gsl_integration_glfixed_table_alloc(20), &gsl_integration_glfixed_table_free);
  double sum = 0;
  for (std::size_t i = 0; i < 20; ++i) {
    double lambda = 0, w = 0;
    gsl_integration_glfixed_point(lower, upper, i, &lambda, &w, table.get());
    sum += w * weight(lambda) * planck_radiance(lambda, inverse_temperature);
  }
  return sum;
}

double band_radiance(double lower, double upper, double temperature) {
  return temperature > 0 ? integrate(lower, upper, 1 / temperature, false) : 0.0;
}

double band_temperature(double lower, double upper, double radiance) {
  if (!(radiance > 0) || !std::isfinite(radiance)) return nan;
  // Wien's law at the middle of the band is the first guess; the logarithm makes Newton converge
  // from far away, since ln L is concave and nearly linear in 1/T.
  const double middle = 0.5 * (lower + upper);
  const double scale = first_radiation_constant / std::pow(middle, 5) * (upper - lower);
  double u = std::log1p(scale / radiance) * middle / second_radiation_constant;
  for (int i = 0; i < 100; ++i) {
    const double l = integrate(lower, upper, u, false);
    const double slope = integrate(lower, upper, u, true);
    if (!(l > 0)) {  // so cold that the radiance underflows: come back towards the warm side
      u *= 0.5;
      continue;
    }
    const double step = std::log(l / radiance) * l / slope;
    const double next = u - step > 0 ? u - step : 0.5 * u;
    if (std::abs(next - u) <= 1e-14 * u) return 1 / next;
    u = next;
  }
  return 1 / u;
}

double signal(const Radiometry& r, double temperature) {
  return signal(r, temperature, r.emissivity);
}

double signal(const Radiometry& r, double temperature, double emissivity) {
  const auto l = [&](double t) { return radiance_of(r, t); };
  return to_signal(r, emissivity, l(temperature), l(r.ambient_temperature),
                   l(r.window_temperature));
}

double temperature(const Radiometry& r, double signal) {
  const auto l = [&](double t) { return radiance_of(r, t); };
  const double surface =
      to_surface_radiance(r, signal, l(r.ambient_temperature), l(r.window_temperature));
  return r.spectrum ? weighted_temperature(*r.spectrum, surface)
                    : band_temperature(r.band_lower, r.band_upper, surface);
}

bool BandTable::Hermite::covers(double x) const {
  return x >= first && x <= first + step * static_cast<double>(value.size() - 1);
}

double BandTable::Hermite::operator()(double x) const {
  const double at = (x - first) / step;
  const auto i = std::min(static_cast<std::size_t>(at), value.size() - 2);
  const double t = at - static_cast<double>(i), s = 1 - t;
  return s * s * ((1 + 2 * t) * value[i] + t * step * slope[i]) +
         t * t * ((1 + 2 * s) * value[i + 1] - s * step * slope[i + 1]);
}

BandTable::BandTable(double lower, double upper, double minimum, double maximum)
    : lower_(lower), upper_(upper) {
  constexpr std::size_t nodes = 4096;
  if (!(minimum > 0 && maximum > minimum))
    throw InputError("A table of radiance needs temperatures 0 < minimum < maximum; found " +
                     shortest(minimum) + " K and " + shortest(maximum) + " K.");
  const auto at = [&](double u, double& value, double& slope) {
    const double l = integrate(lower, upper, u, false);
    if (!(l > 1e-290))
      throw InputError("The band from " + shortest(lower) + " m to " + shortest(upper) +
                       " m has no radiance at " + shortest(1 / u) +
                       " K that a number can hold; raise the table's lowest temperature.");
    value = std::log(l);
    slope = integrate(lower, upper, u, true) / l;
  };
  log_radiance_.first = 1 / maximum;
  log_radiance_.step = (1 / minimum - 1 / maximum) / (nodes - 1);
  log_radiance_.value.resize(nodes);
  log_radiance_.slope.resize(nodes);
  for (std::size_t i = 0; i < nodes; ++i)
    at(log_radiance_.first + static_cast<double>(i) * log_radiance_.step, log_radiance_.value[i],
       log_radiance_.slope[i]);

  auto& inverse = inverse_temperature_;
  inverse.first = log_radiance_.value.back();
  inverse.step = (log_radiance_.value.front() - inverse.first) / (nodes - 1);
  inverse.value.resize(nodes);
  inverse.slope.resize(nodes);
  double u = 1 / minimum;
  for (std::size_t i = 0; i < nodes; ++i) {
    const double wanted = inverse.first + static_cast<double>(i) * inverse.step;
    double value = 0, slope = -1;
    for (int k = 0; k < 20; ++k) {  // from the last node's 1/T on: two or three steps
      at(u, value, slope);
      const double step = (value - wanted) / slope;
      u -= step;
      if (std::abs(step) <= 1e-15 * u) break;
    }
    inverse.value[i] = u;
    inverse.slope[i] = 1 / slope;
  }
}

double BandTable::radiance(double temperature) const {
  if (!(temperature > 0)) return 0;
  const double u = 1 / temperature;
  return log_radiance_.covers(u) ? std::exp(log_radiance_(u))
                                 : band_radiance(lower_, upper_, temperature);
}

double BandTable::temperature(double radiance) const {
  if (!(radiance > 0)) return nan;
  const double x = std::log(radiance);
  return inverse_temperature_.covers(x) ? 1 / inverse_temperature_(x)
                                        : band_temperature(lower_, upper_, radiance);
}

double signal(const Radiometry& r, const BandTable& band, double temperature, double emissivity) {
  return to_signal(r, emissivity, band.radiance(temperature), band.radiance(r.ambient_temperature),
                   band.radiance(r.window_temperature));
}

double temperature(const Radiometry& r, const BandTable& band, double signal) {
  return band.temperature(to_surface_radiance(r, signal, band.radiance(r.ambient_temperature),
                                              band.radiance(r.window_temperature)));
}

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// The moving source and the cooling film: exact but for a quadrature or an ordinary equation.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_odeiv2.h>

#include "solver/verification/exact.hpp"

namespace meltproof::solver {
namespace {

/// GSL stops the program on an error unless told otherwise; here every status is looked at.
void take_over_errors() {
  static const auto previous = gsl_set_error_handler_off();
  static_cast<void>(previous);
}

void check(int status, const char* what) {
  if (status != GSL_SUCCESS) {
    throw std::runtime_error(fmt::format("{}: {}", what, gsl_strerror(status)));
  }
}

}  // namespace

double EagarTsai::operator()(double x, double y, double depth, double time) const {
  take_over_errors();
  const double variance = radius * radius / 4;  // of the beam along one axis
  // In s = sqrt(age) the integrand has no singularity: 2 ds = d age / sqrt(age).
  const auto integrand = [&](double s) {
    const double age = s * s, spread = variance + 2 * diffusivity * age;
    const double along = x - speed * (time - age);
    const double down = depth == 0 ? 0 : depth * depth / (4 * diffusivity * age);
    return std::exp(-(along * along + y * y) / (2 * spread) - down) / spread;
  };
  gsl_function function;
  function.function = [](double s, void* data) {
    return s == 0 ? 0.0 : (*static_cast<decltype(integrand)*>(data))(s);
  };
  auto copy = integrand;
  function.params = &copy;
  const std::unique_ptr<gsl_integration_workspace, decltype(&gsl_integration_workspace_free)> work{
      gsl_integration_workspace_alloc(1000), &gsl_integration_workspace_free};
  double integral = 0, error = 0;
  check(gsl_integration_qag(&function, 0, std::sqrt(time), 0, 1e-8, 1000, GSL_INTEG_GAUSS61,
                            work.get(), &integral, &error),
        "moving source");
  const double heat_capacity = conductivity / diffusivity;  // rho c
  return start_temperature +
         absorbed_power /
             (std::pow(std::numbers::pi, 1.5) * heat_capacity * std::sqrt(diffusivity)) * integral;
}

EagarTsai::Pool EagarTsai::pool(double temperature, double time) const {
  const double beam = speed * time, reach = 4 * radius + 4 * std::sqrt(4 * diffusivity * time);
  // Bisection between a point inside and one outside along a line.
  const auto edge = [&](const auto& at, double inside, double outside) {
    for (int i = 0; i < 60; ++i) {
      const double middle = (inside + outside) / 2;
      (at(middle) >= temperature ? inside : outside) = middle;
    }
    return (inside + outside) / 2;
  };
  Pool pool;
  const auto on_line = [&](double x) { return (*this)(x, 0, 0, time); };
  // The hottest point lies behind the beam's centre, within the beam.
  double hottest = beam;
  for (int i = 0; i <= 200; ++i) {
    const double x = beam - 2 * radius * i / 200;
    hottest = on_line(x) > on_line(hottest) ? x : hottest;
  }
  if (on_line(hottest) < temperature) {
    return pool;
  }
  pool.front = edge(on_line, hottest, beam + reach);
  pool.tail = edge(on_line, hottest, -reach);
  // Width and depth are the largest over the cross-sections.
  const int sections = 80;
  for (int i = 1; i < sections; ++i) {
    const double x = pool.tail + (pool.front - pool.tail) * i / sections;
    pool.width =
        std::max(pool.width, 2 * edge([&](double y) { return (*this)(x, y, 0, time); }, 0, reach));
    pool.depth =
        std::max(pool.depth, edge([&](double z) { return (*this)(x, 0, z, time); }, 0, reach));
  }
  return pool;
}

double cooling_film(const std::function<double(double)>& flux, double capacity, double start,
                    double time) {
  take_over_errors();
  struct Film {
    const std::function<double(double)>& flux;
    double capacity;
  } film{flux, capacity};
  gsl_odeiv2_system system;
  system.function = [](double, const double* y, double* rate, void* data) {
    const auto& f = *static_cast<const Film*>(data);
    rate[0] = -f.flux(y[0]) / f.capacity;
    return static_cast<int>(GSL_SUCCESS);
  };
  system.jacobian = nullptr;
  system.dimension = 1;
  system.params = &film;
  const std::unique_ptr<gsl_odeiv2_driver, decltype(&gsl_odeiv2_driver_free)> driver{
      gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-6 * time, 0, 1e-10),
      &gsl_odeiv2_driver_free};
  double now = 0, temperature = start;
  check(gsl_odeiv2_driver_apply(driver.get(), &now, time, &temperature), "cooling film");
  return temperature;
}

}  // namespace meltproof::solver

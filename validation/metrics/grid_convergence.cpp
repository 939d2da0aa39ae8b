// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/metrics/grid_convergence.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <gsl/gsl_fit.h>

#include "base/error.hpp"

namespace meltproof::validation {

GridConvergence grid_convergence(const std::array<double, 3>& values, double ratio, double safety) {
  const auto& [fine, middle, coarse] = values;
  const double fine_step = middle - fine, coarse_step = coarse - middle;
  const std::string series =
      fmt::format("the series {}, {}, {} (finest first)", fine, middle, coarse);
  if (!(ratio > 1)) {
    throw InputError(fmt::format("the refinement ratio {} is none: expected more than 1.", ratio));
  }
  if (fine_step == 0 || coarse_step == 0) {
    throw InputError(series +
                     " does not change between two spacings, so it has no observed order: "
                     "use spacings that are further apart.");
  }
  if (fine_step * coarse_step < 0) {
    throw InputError(series +
                     " oscillates: it is not monotone in the spacing, so it has no observed "
                     "order; add resolutions or fit four of them by least squares.");
  }
  if (std::abs(coarse_step) <= std::abs(fine_step)) {
    throw InputError(series +
                     " moves apart on refinement: the finest spacing is not yet in the "
                     "range where the error falls.");
  }
  GridConvergence result;
  result.order = std::log(coarse_step / fine_step) / std::log(ratio);
  const double gain = std::pow(ratio, result.order) - 1;
  result.extrapolated = fine - fine_step / gain;
  result.index_fine = safety * std::abs(fine_step / fine) / gain;
  result.index_coarse = safety * std::abs(coarse_step / middle) / gain;
  result.asymptotic = result.index_coarse / ((gain + 1) * result.index_fine);
  result.uncertainty = 0.5 * result.index_fine * std::abs(fine);
  return result;
}

namespace {

/// (h3^p - h2^p) / (h2^p - h1^p), which grows with p.
double step_ratio(const std::array<double, 3>& h, double p) {
  const double fine = std::pow(h[0], p), middle = std::pow(h[1], p), coarse = std::pow(h[2], p);
  return (coarse - middle) / (middle - fine);
}

}  // namespace

ResolutionSeries resolution_series(const std::array<double, 3>& spacings,
                                   const std::array<double, 3>& values) {
  const auto& [h1, h2, h3] = spacings;
  const auto& [fine, middle, coarse] = values;
  if (!(h1 > 0) || !(h2 > h1) || !(h3 > h2)) {
    throw InputError(fmt::format(
        "the spacings {}, {}, {} are no series: expected three that increase.", h1, h2, h3));
  }
  const double lowest = 0.5, formal = 2, highest = 20;
  const double range = std::max({fine, middle, coarse}) - std::min({fine, middle, coarse});
  const double found = (coarse - middle) / (middle - fine);
  const std::array<double, 3> scaled = {h1 / h3, h2 / h3, 1};
  ResolutionSeries result;
  if ((coarse - middle) * (middle - fine) <= 0) {
    result.behaviour = "oscillates";
    result.uncertainty.fill(range / 4);
    return result;
  }
  if (found < step_ratio(scaled, lowest)) {
    result.behaviour = "unsettled";
    result.uncertainty.fill(1.5 * range);
    return result;
  }
  result.behaviour = "converges";
  double low = lowest, high = highest;
  for (int i = 0; i < 100; ++i) {
    const double order = 0.5 * (low + high);
    (step_ratio(scaled, order) < found ? low : high) = order;
  }
  result.order = 0.5 * (low + high);
  result.order_used = std::min(result.order, formal);
  const double p = result.order_used;
  const double gain = std::pow(h2 / h1, p) - 1;
  result.extrapolated = fine - (middle - fine) / gain;
  for (std::size_t i = 0; i < 3; ++i) {
    result.uncertainty[i] = 0.5 * 1.25 * std::abs(values[i] - result.extrapolated);
  }
  return result;
}

double two_grid_index(double fine, double coarse, double ratio, double order, double safety) {
  return safety * std::abs((coarse - fine) / fine) / (std::pow(ratio, order) - 1);
}

FittedConvergence fit_convergence(std::span<const double> spacings,
                                  std::span<const double> values) {
  if (spacings.size() != values.size() || values.size() < 4) {
    throw InputError(
        fmt::format("{} spacings with {} values: a fitted order needs at least four of both.",
                    spacings.size(), values.size()));
  }
  // For a given order the fit is linear in f_exact and a; only the order is searched.
  const auto fit = [&](double order) {
    std::vector<double> power(spacings.size());
    for (std::size_t i = 0; i < power.size(); ++i) {
      power[i] = std::pow(spacings[i] / spacings[0], order);
    }
    FittedConvergence result;
    double c00 = 0, c01 = 0, c11 = 0, squares = 0;
    gsl_fit_linear(power.data(), 1, values.data(), 1, values.size(), &result.extrapolated,
                   &result.amplitude, &c00, &c01, &c11, &squares);
    result.order = order;
    result.scatter = std::sqrt(squares / static_cast<double>(values.size() - 3));
    result.amplitude /= std::pow(spacings[0], order);
    return result;
  };
  const double lowest = 0.2, highest = 4.0, step = 0.05;
  double best = lowest;
  for (int i = 0; lowest + i * step <= highest; ++i) {
    const double order = lowest + i * step;
    best = fit(order).scatter < fit(best).scatter ? order : best;
  }
  // Golden section inside the two neighbours of the best one.
  double low = best - step, high = best + step;
  const double golden = 0.5 * (std::sqrt(5.0) - 1);
  for (int i = 0; i < 60; ++i) {
    const double left = high - golden * (high - low), right = low + golden * (high - low);
    (fit(left).scatter < fit(right).scatter ? high : low) =
        fit(left).scatter < fit(right).scatter ? right : left;
  }
  const auto result = fit(0.5 * (low + high));
  if (result.order <= lowest || result.order >= highest) {
    throw InputError(fmt::format(
        "no order of convergence between {} and {} fits the {} values best: the error does not yet "
        "fall in the way of a power of the spacing.",
        lowest, highest, values.size()));
  }
  return result;
}

}  // namespace meltproof::validation

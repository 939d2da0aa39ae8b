// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/metrics/grid_convergence.hpp"

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

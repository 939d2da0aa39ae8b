// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/interaction_volume.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.hpp"

namespace meltproof::validation {

double kanaya_okayama_range(const Target& target, double beam_energy_kev) {
  const double density = 1e-3 * target.density;  // g/cm3
  return 1e-6 * 0.0276 * target.atomic_weight * std::pow(beam_energy_kev, 1.67) /
         (std::pow(target.atomic_number, 0.89) * density);
}

double anderson_hasler_range(double density, double beam_energy_kev, double edge_energy_kev) {
  if (!(beam_energy_kev > edge_energy_kev)) {
    throw InputError(fmt::format(
        "electrons of {} keV make no X-rays of an edge at {} keV: expected a higher beam energy.",
        beam_energy_kev, edge_energy_kev));
  }
  return 1e-6 * 0.064 * (std::pow(beam_energy_kev, 1.68) - std::pow(edge_energy_kev, 1.68)) /
         (1e-3 * density);
}

double mixture_density(double concentration) {
  const double c = std::clamp(concentration, 0.0, 1.0);
  return 1 / (c / aluminium.density + (1 - c) / iron.density);
}

double kanaya_okayama_range_in_mixture(double concentration, double beam_energy_kev) {
  const double c = std::clamp(concentration, 0.0, 1.0);
  const auto loss = [&](const Target& target) {
    return 1 / (target.density * kanaya_okayama_range(target, beam_energy_kev));
  };
  return 1 / ((c * loss(aluminium) + (1 - c) * loss(iron)) * mixture_density(concentration));
}

double interaction_sigma(double range) { return range / (2 * std::sqrt(2 * std::log(2.0))); }

std::vector<double> convolve_gaussian(std::span<const double> values, double step, double sigma) {
  if (!(step > 0 && sigma >= 0)) {
    throw InputError(fmt::format(
        "a profile in steps of {} cannot be seen with a Gaussian of {}: expected a positive step "
        "and no negative width.",
        step, sigma));
  }
  std::vector<double> seen(values.begin(), values.end());
  if (sigma == 0) {
    return seen;
  }
  // Weights of each cell of the grid, integrated, so that a narrow Gaussian keeps its sum.
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(5 * sigma / step));
  std::vector<double> weights;
  const double scale = step / (sigma * std::sqrt(2.0));
  for (std::ptrdiff_t k = 0; k <= reach; ++k) {
    const auto centre = static_cast<double>(k);
    weights.push_back(0.5 * (std::erf((centre + 0.5) * scale) - std::erf((centre - 0.5) * scale)));
  }
  const auto n = static_cast<std::ptrdiff_t>(values.size());
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    if (std::isnan(values[static_cast<std::size_t>(i)])) {
      continue;
    }
    double sum = 0, weight = 0;
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(0, i - reach); j <= std::min(n - 1, i + reach);
         ++j) {
      const double value = values[static_cast<std::size_t>(j)];
      if (!std::isnan(value)) {
        const double w = weights[static_cast<std::size_t>(std::abs(i - j))];
        sum += w * value;
        weight += w;
      }
    }
    seen[static_cast<std::size_t>(i)] = sum / weight;
  }
  return seen;
}

std::vector<double> convolve_in_matrix(std::span<const double> values,
                                       std::span<const double> densities, double step,
                                       double sigma_mass) {
  if (!(step > 0 && sigma_mass >= 0) || values.size() != densities.size()) {
    throw InputError(fmt::format(
        "{} values with {} densities in steps of {} cannot be seen with a Gaussian of {} kg/m2: "
        "expected equal numbers, a positive step and no negative width.",
        values.size(), densities.size(), step, sigma_mass));
  }
  std::vector<double> seen(values.begin(), values.end());
  if (sigma_mass == 0) {
    return seen;
  }
  // Edges of the cells in mass per area; cell i lies between edge i and i + 1.
  std::vector<double> edge = {0};
  for (const double density : densities) {
    edge.push_back(edge.back() + density * step);
  }
  const double scale = 1 / (sigma_mass * std::sqrt(2.0));
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) {
      continue;
    }
    const double beam = 0.5 * (edge[i] + edge[i + 1]);
    double sum = 0, weight = 0;
    for (std::size_t j = 0; j < values.size(); ++j) {
      if (!std::isnan(values[j])) {
        const double w =
            std::erf((edge[j + 1] - beam) * scale) - std::erf((edge[j] - beam) * scale);
        sum += w * values[j];
        weight += w;
      }
    }
    seen[i] = sum / weight;
  }
  return seen;
}

}  // namespace meltproof::validation

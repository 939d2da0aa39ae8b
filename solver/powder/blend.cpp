// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/powder/blend.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace meltproof::solver {
namespace {

double mass(const Sphere& sphere, double density) {
  return density * 4 / 3 * std::numbers::pi * std::pow(sphere.radius, 3);
}

}  // namespace

double Blend::additive_number_fraction() const {
  const double w = additive_mass_fraction;
  const double additive_number = w / (additive_density * additive.moment(3));
  const double base_number = (1 - w) / (base_density * base.moment(3));
  return additive_number / (additive_number + base_number);
}

double Blend::draw(Random& random) const {
  return (random.uniform() < additive_number_fraction() ? additive : base).draw(random);
}

double Blend::additive_probability(double d) const {
  const double share = additive_number_fraction();
  if (base.deviation() == 0 || additive.deviation() == 0) {
    // A single size has no density: it belongs to the powder that has this very size.
    const bool of_additive =
        additive.deviation() == 0 ? d == additive.median() : d != base.median();
    const bool of_base = base.deviation() == 0 ? d == base.median() : d != additive.median();
    return of_additive && of_base ? share : (of_additive ? 1 : 0);
  }
  const double a = share * additive.number_density(d), b = (1 - share) * base.number_density(d);
  return a + b > 0 ? a / (a + b) : 0;
}

std::vector<std::int32_t> assign_materials(const std::vector<Sphere>& spheres, const Blend& blend,
                                           Random& random) {
  std::vector<std::int32_t> material(spheres.size(), 0);
  // Pareto sampling (Rosen 1997): in the order of the odds of a uniform number over the odds of the
  // probability, those below 1 are a draw of each sphere for itself; the target moves that limit a
  // little and leaves the probabilities as they are.
  std::vector<std::pair<double, std::size_t>> order;
  double base_mass = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double p = blend.additive_probability(2 * spheres[i].radius);
    const double u = random.uniform();
    if (p > 0) {
      order.emplace_back(u / (1 - u) * ((1 - p) / p), i);
    }
    base_mass += mass(spheres[i], blend.base_density);
  }
  std::sort(order.begin(), order.end());
  double additive_mass = 0;
  const double target = blend.additive_mass_fraction;
  double error = target;
  for (const auto& [key, i] : order) {
    base_mass -= mass(spheres[i], blend.base_density);
    additive_mass += mass(spheres[i], blend.additive_density);
    const double now =
        std::abs(additive_mass / (additive_mass + std::max(base_mass, 0.0)) - target);
    if (now >= error) {
      break;
    }
    error = now;
    material[i] = 1;
  }
  return material;
}

double additive_mass_fraction(const std::vector<Sphere>& spheres,
                              const std::vector<std::int32_t>& material, const Blend& blend) {
  double additive = 0, all = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double one =
        mass(spheres[i], material[i] == 1 ? blend.additive_density : blend.base_density);
    all += one;
    additive += material[i] == 1 ? one : 0;
  }
  return all > 0 ? additive / all : 0;
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// Which of a bed's spheres are of the additive.
#pragma once

#include <cstdint>
#include <vector>

#include "solver/powder/drop_and_roll.hpp"
#include "solver/powder/size_distribution.hpp"

namespace meltproof::solver {

/// Two powders blended by mass.
struct Blend {
  SizeDistribution base, additive;
  double base_density, additive_density;  ///< kg m-3
  double additive_mass_fraction;          ///< 1

  /// Share of the additive among the spheres by number.
  double additive_number_fraction() const;
  /// A diameter from either powder, in the blend's proportion, m.
  double draw(Random& random) const;
  /// Probability that a sphere of diameter d is of the additive (Bayes).
  double additive_probability(double d) const;
};

/// The material of each sphere, 0 base or 1 additive. Each is of the additive with the probability
/// Blend::additive_probability of its size, but all together so that the additive's mass fraction
/// of these very spheres is as near to the blend's as whole spheres allow: chance does not thin out
/// or enrich a small bed.
std::vector<std::int32_t> assign_materials(const std::vector<Sphere>& spheres, const Blend& blend,
                                           Random& random);

/// Mass of the additive over the mass of all.
double additive_mass_fraction(const std::vector<Sphere>& spheres,
                              const std::vector<std::int32_t>& material, const Blend& blend);

}  // namespace meltproof::solver

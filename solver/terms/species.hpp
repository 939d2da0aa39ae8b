// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "solver/particles/kernel.hpp"
#include "solver/particles/packed_lists.hpp"

namespace meltproof::solver {

/// Which factor the species term carries.
enum class SpeciesFactor {
  consistent,  ///< 2 D_i D_j/(D_i + D_j): the Laplacian of x^2 is 2 (Cleary & Monaghan 1999)
  as_printed,  ///< 4 D_i D_j/(D_i + D_j), the paper's Eq. 2: twice too much (paper errata 1)
};

/// **Alloy diffusion**: dC_i/dt = 1/rho_i sum_j V_j 2 D_i D_j/(D_i + D_j) (rho_i + rho_j) F_ij (C_i
/// - C_j) (the paper's Eq. 2 with the consistent factor; `factor` is 2, or 4 as printed). Zero
/// unless both are liquid, because D is zero in the solid. Returns one summand without 1/rho_i, kg
/// m-3 s-1.
template <class T>
T species_pair(const T& diffusivity_i, const T& density_i, const T& concentration_i,
               const T& diffusivity_j, const T& density_j, const T& concentration_j,
               const T& volume_j, const T& gradient_factor, double factor) {
  // The floor only keeps 0/0 from arising between two solids; it is far below any diffusivity.
  const T sum = larger(diffusivity_i + diffusivity_j, T(1e-300));
  const T mean = factor * diffusivity_i * (diffusivity_j / sum);
  return volume_j * mean * (density_i + density_j) * gradient_factor *
         (concentration_i - concentration_j);
}

/// What the species pass needs of a particle, packed into one cache line.
template <class T>
struct alignas(64) SpeciesFields {
  T x = void_position, y = void_position, z = void_position;  ///< m
  T volume = 0.0;                                             ///< m^d
  T density = 0.0;                                            ///< kg m-3
  T concentration = 0.0;                                      ///< mass fraction
  T diffusivity = 0.0;                                        ///< m2 s-1, above zero
  T unused = 0.0;
};
using SpeciesRecord = SpeciesFields<double>;

/// Those that exchange additive: only what is liquid does, a small part of all. Records, and where
/// to find them.
struct SpeciesRecords {
  std::vector<std::uint32_t> place;    ///< in `records`, of particles, images and the void
  std::vector<SpeciesRecord> records;  ///< the last one is the void: of all that exchange nothing
};

/// Rate of change of the concentration, 1/s. @param members particles that exchange;
/// @param rate one for each of them, overwritten.
void diffuse(const SpeciesRecords& all, const PackedLists& neighbours, const QuinticSpline& kernel,
             SpeciesFactor factor, const std::vector<std::uint32_t>& members,
             std::vector<double>& rate);

}  // namespace meltproof::solver

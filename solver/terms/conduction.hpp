// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "solver/particles/kernel.hpp"
#include "solver/particles/packed_lists.hpp"

namespace meltproof::solver {

/// **Heat conduction in enthalpy form**: dH_i/dt = 1/rho_i sum_j V_j 4 k_i k_j/(k_i + k_j) F_ij
/// (T_i - T_j). Harmonic mean of the conductivities, so that the flux is continuous where they
/// jump. (Cleary & Monaghan 1999) Returns one summand without 1/rho_i, W m-3. Antisymmetric once
/// multiplied by V_i.
template <class T>
T conduction_pair(const T& conductivity_i, const T& temperature_i, const T& conductivity_j,
                  const T& temperature_j, const T& volume_j, const T& gradient_factor) {
  const T mean = 4.0 * conductivity_i * conductivity_j / (conductivity_i + conductivity_j);
  return volume_j * mean * gradient_factor * (temperature_i - temperature_j);
}

/// How often a particle exchanges heat, see Engine::exchange_heat().
namespace pace {
inline constexpr std::uint8_t slow = 0,  ///< once in a round of steps
    every_step = 1,                      ///< in every step
    substeps = 2,  ///< in parts of a step: it conducts too well for whole ones
    asleep = 3;    ///< conducts as well, but is as cold as it began: not in this round
}  // namespace pace

/// What the conduction pass needs of a particle, packed into one cache line.
template <class T>
struct alignas(64) HeatFields {
  T x = void_position, y = void_position, z = void_position;  ///< m
  T volume = 0.0;                                             ///< m^d
  T temperature = 0.0;                                        ///< K
  T conductivity = 1.0;                                       ///< W m-1 K-1
  T awake = 1.0;  ///< 0: as cold as it began; two such exchange nothing
  T pace = 0.0;   ///< one of namespace pace
};
using HeatRecord = HeatFields<double>;

/// The particles that exchange heat: those awake and the neighbours of those, in increasing order.
/// A pair counts if either is awake, so what one gets the other gives, and energy stays exact.
void find_awake(const std::vector<HeatRecord>& records, const PackedLists& neighbours,
                std::vector<std::uint32_t>& active);

/// Conducted power per volume, W m-3, of the particles in `active`; zero for the others.
/// @param records particles, then ghosts, then the void; @param power size n, overwritten.
void conduct(const std::vector<HeatRecord>& records, const PackedLists& neighbours,
             const QuinticSpline& kernel, const std::vector<std::uint32_t>& active,
             std::vector<double>& power);
/// What conduct() finds of slow particles beside others, apart: the power from neighbours of
/// `every_step` into `from_fast`, that from slow ones into `from_slow` unless it is null, W m-3.
/// Only entries of `members` are written.
void conduct_apart(const std::vector<HeatRecord>& records, const PackedLists& neighbours,
                   const QuinticSpline& kernel, const std::vector<std::uint32_t>& members,
                   std::vector<double>& from_fast, std::vector<double>* from_slow);
/// Conducted power per volume, W m-3, from those neighbours only whose pace is one from `lowest` to
/// `highest`. @param power one for each of `members`, overwritten.
void conduct_with(const std::vector<HeatRecord>& records, const PackedLists& neighbours,
                  const QuinticSpline& kernel, const std::vector<std::uint32_t>& members,
                  std::uint8_t lowest, std::uint8_t highest, double* power);
/// conduct() of every particle.
void conduct(const std::vector<HeatRecord>& records, const PackedLists& neighbours,
             const QuinticSpline& kernel, std::vector<double>& power);

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// The pair loop whose speed decides what a user can afford: continuity, pressure, viscosity, heat
// and species in one pass over a Verlet list of packed records. Written once, for doubles and for
// lanes of them. It measures what the lists, the records and the pair functions allow; the solver's
// own passes read other records and look at more than these five terms.
#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

#include "solver/particles/kernel.hpp"
#include "solver/particles/lanes.hpp"
#include "solver/particles/neighbours.hpp"
#include "solver/terms/conduction.hpp"
#include "solver/terms/continuity.hpp"
#include "solver/terms/pressure.hpp"
#include "solver/terms/species.hpp"
#include "solver/terms/viscosity.hpp"

namespace meltproof::solver {

/// All that the five terms need of a particle; two cache lines of doubles.
template <class T>
struct alignas(64) PairFields {
  T x = void_position, y = void_position, z = void_position;  ///< m
  T volume = 0;                                               ///< m3
  T vx = 0, vy = 0, vz = 0;                                   ///< m s-1
  T density = 1;                                              ///< kg m-3
  T pressure = 0;                                             ///< Pa
  T viscosity = 1;                                            ///< Pa s
  T temperature = 0;                                          ///< K
  T conductivity = 1;                                         ///< W m-1 K-1
  T concentration = 0;                                        ///< mass fraction
  T diffusivity = 1;                                          ///< m2 s-1
  T unused_1 = 0, unused_2 = 0;                               ///< fill the lines
};

/// What the terms give a particle, each before its last factor.
struct PairRates {
  double density = 0;             ///< kg m-3 s-1
  double fx = 0, fy = 0, fz = 0;  ///< N, pressure and viscosity
  double power = 0;               ///< W m-3, conducted
  double concentration = 0;       ///< kg m-3 s-1, diffused
};

/// Sums over the neighbours, in lanes or one by one.
template <class T>
struct PairSums {
  T compression = 0;         ///< 1/s
  T fx = 0, fy = 0, fz = 0;  ///< N
  T power = 0;               ///< W m-3
  T concentration = 0;       ///< kg m-3 s-1
};

/// Of four positive numbers the reciprocals, by one division.
template <class T>
struct Reciprocals {
  T a, b, c, d;

  [[gnu::always_inline]] Reciprocals(const T& of_a, const T& of_b, const T& of_c, const T& of_d) {
    const T ab = of_a * of_b, cd = of_c * of_d, all = T(1.0) / (ab * cd);
    const T over_ab = cd * all, over_cd = ab * all;
    a = of_b * over_ab;
    b = of_a * over_ab;
    c = of_d * over_cd;
    d = of_c * over_cd;
  }
};

/// **Adds one pair** to all five terms: geometry and kernel once, then the formulas of terms/, with
/// their quotients rearranged. As those formulas stand a pair takes six divisions and a root, which
/// keep the divider busy for two thirds of the time, in lanes as well as one by one; here it takes
/// two and a root. Viscosities, conductivities and diffusivities must be positive.
/// @param square_i V_i^2, m6.
template <class T>
[[gnu::always_inline]] inline void add_pair(PairSums<T>& sums, const PairFields<T>& own,
                                            const T& square_i, const PairFields<T>& other,
                                            const QuinticSpline& kernel) {
  const T dx = own.x - other.x, dy = own.y - other.y, dz = own.z - other.z;
  const T r2 = dx * dx + dy * dy + dz * dz;
  // The floor only keeps 0/0 from arising where two particles meet.
  const T r = square_root(larger(r2, T(1e-30)));
  // W'/r and F = r W'/(r^2 + (0.1 h)^2) have one division in common.
  const T softened = r2 + kernel.regularisation;
  const T slope = kernel.slope(r), share = slope * (T(1.0) / (r * softened));
  const T slope_over_r = softened * share, factor = r * r * share;
  const T approach = dx * (own.vx - other.vx) + dy * (own.vy - other.vy) + dz * (own.vz - other.vz);
  sums.compression += continuity_pair(other.volume, slope_over_r, approach);
  const Reciprocals<T> over(own.viscosity + other.viscosity, own.density + other.density,
                            own.conductivity + other.conductivity,
                            own.diffusivity + other.diffusivity);
  // viscosity_pair(), pressure_pair()
  const T rub = 2.0 * own.viscosity * other.viscosity * over.a *
                central_viscosity(slope_over_r, kernel.second_moment, 3);
  const T pressure = (other.density * own.pressure + own.density * other.pressure) * over.b;
  const T along =
      (square_i + other.volume * other.volume) * (rub * approach - slope_over_r * pressure);
  sums.fx += along * dx;
  sums.fy += along * dy;
  sums.fz += along * dz;
  // conduction_pair(), species_pair()
  const T exchange = other.volume * factor;
  sums.power += exchange * (4.0 * own.conductivity * other.conductivity * over.c) *
                (own.temperature - other.temperature);
  sums.concentration += exchange * (2.0 * own.diffusivity * other.diffusivity * over.d) *
                        (own.density + other.density) * (own.concentration - other.concentration);
}

namespace pair_loop_detail {

inline double total(double value) { return value; }
inline double total(const Lane& value) { return sum_lanes(value); }

/// The same particle in every lane.
inline PairFields<Lane> spread(const PairFields<double>& r) {
  return {r.x,
          r.y,
          r.z,
          r.volume,
          r.vx,
          r.vy,
          r.vz,
          r.density,
          r.pressure,
          r.viscosity,
          r.temperature,
          r.conductivity,
          r.concentration,
          r.diffusivity,
          0.0,
          0.0};
}

}  // namespace pair_loop_detail

/// One pass of the five terms over all particles. @tparam T double or Lane. @param records
/// particles, then the void; @param rates one per particle, overwritten.
template <class T>
void five_terms(const std::vector<PairFields<double>>& records, const NeighbourList& list,
                const QuinticSpline& kernel, std::vector<PairRates>& rates) {
  using pair_loop_detail::total;
  constexpr bool lanes = !std::is_same_v<T, double>;
  constexpr std::size_t width = lanes ? lane_count : 1;
  const PairFields<double>* all = records.data();
  for (std::size_t i = 0; i < rates.size(); ++i) {
    PairFields<T> own;
    if constexpr (lanes) {
      own = pair_loop_detail::spread(all[i]);
    } else {
      own = all[i];
    }
    const T square = own.volume * own.volume;
    PairSums<T> sums;
    for (std::size_t k = list.first[i]; k < list.last[i]; k += width) {
      if constexpr (lanes) {
        add_pair(sums, own, square, gather_records(all, &list.index[k]), kernel);
      } else {
        add_pair(sums, own, square, all[list.index[k]], kernel);
      }
    }
    rates[i] = {all[i].density * total(sums.compression),
                total(sums.fx),
                total(sums.fy),
                total(sums.fz),
                total(sums.power),
                total(sums.concentration)};
  }
}

}  // namespace meltproof::solver

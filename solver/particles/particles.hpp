// SPDX-License-Identifier: GPL-3.0-or-later
// The state of the particles. What a particle is (identity, origin, material, phase) is data; its
// place in memory means nothing and changes whenever particles are put in space-filling order.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace meltproof::solver {

using Vector = std::array<double, 3>;  ///< x (scan direction), y (lateral), z (up), m

/// Where a particle came from.
enum class Origin : std::int32_t { plate = 0, base_powder = 1, additive_powder = 2 };

/// How a particle takes part in the flow.
enum class Phase : std::uint8_t {
  solid = 0,   ///< fixed in space, a wall to the melt
  liquid = 1,  ///< moves
  gas = 2,     ///< moves; only in a closed multi-phase flow
  lost = 3,    ///< left the domain: stays where it left, takes part in nothing
};

/// All particles, one entry per particle in every array.
struct Particles {
  int dimensions = 3;
  double spacing = 0;                    ///< m
  std::vector<std::int64_t> identity;    ///< unique, kept for life
  std::vector<Vector> position;          ///< m
  std::vector<Vector> velocity;          ///< m s-1
  std::vector<double> mass;              ///< kg (per m of depth in two dimensions)
  std::vector<double> volume;            ///< m^d, undisturbed: mass over reference density
  std::vector<double> density;           ///< kg m-3, of the flow; the reference density at rest
  std::vector<double> enthalpy;          ///< J kg-1
  std::vector<double> concentration;     ///< mass fraction of the additive
  std::vector<double> temperature;       ///< K, follows from enthalpy and concentration
  std::vector<double> liquid_fraction;   ///< 1, follows likewise
  std::vector<double> peak_temperature;  ///< K, the highest so far
  std::vector<double> melt_time;         ///< s, last time above its liquidus first; -1: never
  std::vector<double> freeze_time;       ///< s, last time below its liquidus again; -1: never
  std::vector<double> cooling_rate;      ///< K s-1, at freeze_time
  std::vector<double> freeze_gradient;   ///< K m-1, |grad T| at freeze_time
  std::vector<Origin> origin;
  std::vector<Phase> phase;
  std::vector<std::uint8_t> melted;  ///< 1 once the particle has been fully liquid

  std::size_t size() const { return identity.size(); }
  /// Appends a particle at rest; temperature and liquid fraction follow with the first step.
  void add(std::int64_t id, const Vector& at, double m, double v, double h, double c, Origin from);
};

/// Puts the particles in Morton order of cells of the given size, by identity within a cell: the
/// order depends on the particles alone, neither on how they were made nor on threads.
void sort_in_space(Particles& particles, double cell_size);

}  // namespace meltproof::solver

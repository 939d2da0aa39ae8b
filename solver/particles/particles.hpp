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

/// Whose a particle is, where several ranks share a run.
enum class Home : std::uint8_t {
  nowhere = 0,    ///< no particle: it moved to another rank, and its entries are free
  here = 1,       ///< of this rank, which computes it
  elsewhere = 2,  ///< a copy of another rank's, near this one's
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
  /// Who comes first in every sum over neighbours, then by identity: the space-filling order when
  /// the particles were last sorted, whatever their indices on this rank.
  std::vector<std::uint64_t> order;
  std::vector<Home> home;  ///< all here, but where several ranks share a run

  std::size_t size() const { return identity.size(); }
  /// Appends a particle at rest; temperature and liquid fraction follow with the first step.
  void add(std::int64_t id, const Vector& at, double m, double v, double h, double c, Origin from);
  /// Calls visit(values) for each array, of whatever type.
  template <class Visit>
  void each_array(const Visit& visit) {
    each_array(*this, [&](const auto&, auto& values) { visit(values); });
  }
  /// Calls visit(values, others) for each array and that of another set of particles.
  template <class Visit>
  void each_array(Particles& other, const Visit& visit) const;
  /// Whether particle a comes before particle b in sums.
  bool before(std::uint32_t a, std::uint32_t b) const {
    return order[a] != order[b] ? order[a] < order[b] : identity[a] < identity[b];
  }
};

template <class Visit>
void Particles::each_array(Particles& other, const Visit& visit) const {
  visit(identity, other.identity);
  visit(position, other.position);
  visit(velocity, other.velocity);
  visit(mass, other.mass);
  visit(volume, other.volume);
  visit(density, other.density);
  visit(enthalpy, other.enthalpy);
  visit(concentration, other.concentration);
  visit(temperature, other.temperature);
  visit(liquid_fraction, other.liquid_fraction);
  visit(peak_temperature, other.peak_temperature);
  visit(melt_time, other.melt_time);
  visit(freeze_time, other.freeze_time);
  visit(cooling_rate, other.cooling_rate);
  visit(freeze_gradient, other.freeze_gradient);
  visit(origin, other.origin);
  visit(phase, other.phase);
  visit(melted, other.melted);
  visit(order, other.order);
  visit(home, other.home);
}

/// The least coordinates of all particles, m; infinite without any.
Vector lower_corner(const Particles& particles);

/// Puts the particles in Morton order of cells of the given size, by identity within a cell: the
/// order depends on the particles alone, neither on how they were made nor on threads. Sets
/// Particles::order.
void sort_in_space(Particles& particles, double cell_size);
/// The place of a point in that order. @param lower corner from which cells are counted, m.
std::uint64_t place_in_space(const Vector& at, const Vector& lower, double cell_size);
/// The same with cells counted from `lower`, the corner of the particles of all ranks, m.
void sort_in_space(Particles& particles, double cell_size, const Vector& lower);

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// The illuminated surface: columns of half a spacing along the beam, each with the first metal
// particle that light in it meets.
#pragma once

#include <cstdint>
#include <vector>

#include "solver/parallel/ranks.hpp"
#include "solver/particles/particles.hpp"

namespace meltproof::solver {

/// How far a slanted column moves along x and y for each metre that it descends: the beam's
/// horizontal over its downward direction. Zero for a vertical beam.
struct Slant {
  double x = 0, y = 0;
};

/// Columns along the beam over the domain's plan view, numbered by where they meet the plane z = 0.
/// A particle, moved along the beam onto that plane, fills the columns whose axes pass within half
/// a spacing of it along x and y; the highest one is met first, so particles shadow what is behind
/// them and neither normals nor the decomposition matter. Up to 45 degrees no light slips between
/// the layers of a lattice.
struct SurfaceColumns {
  static constexpr std::uint32_t none = 0xffffffff;  ///< no metal in this column, or too far off
  static constexpr std::uint32_t elsewhere = 0xfffffffe;  ///< another rank's particle is on top
  double lower_x = 0, lower_y = 0;                        ///< m
  double width = 0;                                       ///< m, half a spacing
  std::size_t count_x = 0, count_y = 0;
  std::vector<std::uint32_t> top;  ///< particle index per column, row-major [y][x]

  std::uint32_t at(std::size_t ix, std::size_t iy) const { return top[iy * count_x + ix]; }
};

/// Finds the topmost particle of every column, lost ones apart; of equally high ones the one with
/// the smaller identity. Where a particle of this rank is on top, it is so among those of all
/// ranks: columns stand upright in the ranks' boxes, and slanted ones are settled among all ranks
/// (collectively).
/// @param lower, upper plan view of the domain in m; @param slant of the columns, of the beam.
SurfaceColumns find_surface(const Particles& particles, const Vector& lower, const Vector& upper,
                            const Slant& slant = {}, const Ranks& ranks = {});

/// **The same, again and again, of particles most of which stand still.** What lies well below the
/// surface is looked at only when the surface has sunk towards it, so a call costs by the area of
/// the domain instead of its volume. The result is that of find_surface().
class SurfaceSearch {
 public:
  /// As find_surface(). Who is neither new since forget() nor was named to moves() stands where it
  /// stood.
  SurfaceColumns find(const Particles& particles, const Vector& lower, const Vector& upper,
                      const Slant& slant, const Ranks& ranks);
  /// To be called when indices have changed.
  void forget();
  /// To be told, by index, who may move from now on; once told it holds until forget().
  void moves(const std::vector<std::uint32_t>& particles);

 private:
  void choose(const SurfaceColumns& columns, const Particles& particles, const Slant& slant);

  bool known_ = false;
  // Those near the surface, and those who may have moved, some in both.
  std::vector<std::uint32_t> candidates_, movers_;
  std::vector<std::uint8_t> moves_;  // by particle, as far as somebody does
  // Of every column: what is neither lies below the floor; nobody stood there.
  std::vector<double> floor_;  // m
  std::vector<std::uint8_t> bare_;
};

}  // namespace meltproof::solver

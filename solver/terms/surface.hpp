// SPDX-License-Identifier: GPL-3.0-or-later
// The illuminated surface: columns of half a spacing, each with the topmost metal particle it
// meets.
#pragma once

#include <cstdint>
#include <vector>

#include "solver/particles/particles.hpp"

namespace meltproof::solver {

/// Columns along z over the domain's plan view. A particle fills the columns whose axes pass within
/// half a spacing of it along x and y; the highest one sees the beam, so particles shadow what is
/// below them and neither normals nor the decomposition matter.
struct SurfaceColumns {
  static constexpr std::uint32_t none = 0xffffffff;  ///< no metal in this column
  double lower_x = 0, lower_y = 0;                   ///< m
  double width = 0;                                  ///< m, half a spacing
  std::size_t count_x = 0, count_y = 0;
  std::vector<std::uint32_t> top;  ///< particle index per column, row-major [y][x]

  std::uint32_t at(std::size_t ix, std::size_t iy) const { return top[iy * count_x + ix]; }
};

/// Finds the topmost particle of every column; of equally high ones the one with the smaller
/// identity.
/// @param lower, upper plan view of the domain in m.
SurfaceColumns find_surface(const Particles& particles, const Vector& lower, const Vector& upper);

}  // namespace meltproof::solver

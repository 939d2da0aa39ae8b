// SPDX-License-Identifier: GPL-3.0-or-later
// The size of the melt pool, resolved finer than the spacing.
#pragma once

#include <vector>

#include "solver/particles/packed_lists.hpp"
#include "solver/particles/particles.hpp"

namespace meltproof::solver {

/// Particles nearer than this touch, in spacings.
inline constexpr double touching = 1.8;

/// Extent of a region; depth is measured down from the plate's surface z = 0.
struct Extent {
  bool found = false;
  double onset = 0, end = 0;  ///< x of the front and of the tail, m; length = onset - end
  double length = 0, width = 0, depth = 0;  ///< m
  double volume = 0;                        ///< m3, of the particles inside
};

/// Extent of the region where `level` is not negative, bounded by the points at which it crosses
/// zero between a particle inside and a neighbour outside (linear interpolation), so that the
/// result does not jump by whole spacings.
/// @param level per particle, for example T - T_ref; @param connected keep only the largest
/// connected region by volume (of particles that touch): the hottest particle may be spray.
Extent measure_extent(const Particles& particles, const PackedLists& neighbours,
                      const std::vector<double>& level, bool connected);

}  // namespace meltproof::solver

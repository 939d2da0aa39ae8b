// SPDX-License-Identifier: GPL-3.0-or-later
// Which way a sphere goes that touches others: the one rule from which falling, rolling over one
// sphere, rolling over two and resting on three all follow.
#pragma once

#include <array>
#include <span>

#include <Eigen/Core>

namespace meltproof::solver {

/// The direction of steepest descent that no contact forbids, and the contacts that carry.
struct Descent {
  Eigen::Vector3d direction{0, 0, -1};  ///< gravity less what the carrying contacts take; 0 at rest
  std::array<int, 3> carrying{};        ///< indices of the contacts with a force, `count` of them
  int count = 0;                        ///< 0 falls, 1 or 2 rolls, 3 rests
  bool rests = false;                   ///< nothing is left of gravity
};

/// The projection of gravity g = (0, 0, -1) onto the cone { v : v . e_i >= 0 }: v = g + sum N_i e_i
/// with contact forces N_i >= 0 and N_i v . e_i = 0. It is found by trying sets of one, two and
/// three contacts, the smallest first, so that a contact whose force has just vanished is let go.
/// @param directions unit vectors e_i from each touched sphere, wall or floor to the sphere.
Descent steepest_descent(std::span<const Eigen::Vector3d> directions);

}  // namespace meltproof::solver

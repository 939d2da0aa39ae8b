// SPDX-License-Identifier: GPL-3.0-or-later
// How neighbour lists are made: cell by cell, sorted, whatever the number of threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/particles/cell_grid.hpp"
#include "solver/particles/packed_lists.hpp"

namespace meltproof::solver {

/// The order in which neighbours stand in lists: particles by Particles::before(), images behind
/// them by index. Indices follow it up to the first particle that came from another rank since the
/// last sort.
struct ListOrder {
  const Particles& particles;
  std::uint32_t alike = 0;  ///< below this index, order and index are the same

  explicit ListOrder(const Particles& p);
  bool operator()(std::uint32_t a, std::uint32_t b) const;
  void sort(std::vector<std::uint32_t>& indices) const;
};

/// Below which distance two points are neighbours: the larger of theirs.
struct ListLimits {
  double near = 0, far = 0;          ///< m2
  std::vector<std::uint8_t> moving;  ///< per point: 1 takes `far`; none: all take `near`

  double operator[](std::size_t i) const { return moving.empty() || moving[i] == 0 ? near : far; }
};

/// Appends the lists of `members` to list.code in their order and sets their first and last. Made
/// block by block: beside the lists themselves there is only a block of them in memory.
/// @param grid of all points that may be neighbours, cells as large as the longest reach.
void append_lists(PackedLists& list, const CellGrid& grid, const ListOrder& order,
                  const Points& points, std::span<const std::uint32_t> members,
                  const ListLimits& limits);

}  // namespace meltproof::solver

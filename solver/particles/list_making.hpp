// SPDX-License-Identifier: GPL-3.0-or-later
// How neighbour lists are made: cell by cell, sorted, whatever the number of threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/particles/cell_grid.hpp"
#include "solver/particles/neighbours.hpp"

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

/// Appends the lists of `members` to list.index in their order and sets their first and last. Made
/// block by block: beside the lists themselves there is only a block of them in memory.
/// @param grid of all points that may be neighbours, cells as large as the longest reach; @param
/// limits per point, m2: two points are neighbours below the larger of theirs.
void append_lists(NeighbourList& list, const CellGrid& grid, const ListOrder& order,
                  const Points& points, std::span<const std::uint32_t> members,
                  const std::vector<double>& limits);

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// Neighbour lists: who is within the kernel's support, in an order that belongs to the particle.
#pragma once

#include <cstdint>
#include <vector>

#include "solver/particles/ghosts.hpp"
#include "solver/particles/particles.hpp"

namespace meltproof::solver {

/// A place in NeighbourList::index: half the size of a pointer, as there are two per particle.
using ListPlace = std::uint32_t;
/// The same of a count. @throws std::length_error from some 40 million particles on.
ListPlace list_place(std::size_t place);

/// For every particle the indices of its neighbours without itself: particles count from 0, ghosts
/// follow behind them, and the void record, which takes part in nothing, is the last index. Each
/// list is in the order of Particles::before(), that is in space-filling order, and padded with the
/// void to whole lanes. Only particles of this rank have one. Quick to read; what a run keeps for
/// all of its particles stands in PackedLists.
struct NeighbourList {
  std::vector<ListPlace> first;  ///< list of i begins at index[first[i]]; size n + 1
  std::vector<ListPlace> last;   ///< and ends before index[last[i]]; size n. Lists made in one go
                                 ///< follow each other: last[i] == first[i + 1]
  std::vector<std::uint32_t> index;
  std::uint32_t void_index = 0;
  double reach = 0;  ///< m, the largest distance listed

  double mean_neighbours() const;
};

/// Builds the lists by a cell grid. @param reach the kernel's support, plus a skin when particles
/// move.
NeighbourList make_neighbours(const Particles& particles, const std::vector<Ghost>& ghosts,
                              double reach);

/// A position that is outside the support of every kernel but whose distances stay finite, for the
/// void record.
inline constexpr double void_position = 1e30;

}  // namespace meltproof::solver

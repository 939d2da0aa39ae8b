// SPDX-License-Identifier: GPL-3.0-or-later
// Neighbour lists in half the room: what a run keeps for every particle.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/particles/neighbours.hpp"

namespace meltproof::solver {

/// Room into which a list is unpacked. Who reads many lists keeps it, so that reading allocates
/// nothing.
using ListBuffer = std::vector<std::uint32_t>;

/// **The lists of NeighbourList in 2 bytes an entry.** Neighbours stand in space-filling order, so
/// the indices of a list lie close together: a list is a few runs, each the smallest index of the
/// run in two words (low, high), the number of its entries, and their distances from that index.
/// The void with which lists are filled up to whole lanes is added when they are read.
struct PackedLists {
  std::vector<ListPlace> first;     ///< the list of i begins at code[first[i]]; size n
  std::vector<ListPlace> last;      ///< and ends before code[last[i]]; size n
  std::vector<std::uint16_t> code;  ///< runs
  std::uint32_t void_index = 0;
  double reach = 0;  ///< m, the largest distance listed

  std::size_t size() const { return last.size(); }
  /// How many neighbours particle i has listed.
  std::size_t count(std::size_t i) const;
  /// Calls visit(j) for each of them, in order.
  template <class Visit>
  void each(std::size_t i, const Visit& visit) const {
    any(i, [&](std::uint32_t j) {
      visit(j);
      return false;
    });
  }
  /// Whether test(j) holds for one of them; asks no further ones.
  template <class Test>
  bool any(std::size_t i, const Test& test) const;
  /// All of them, filled up with the void to whole lanes; stands until `buffer` is used again.
  std::span<const std::uint32_t> of(std::size_t i, ListBuffer& buffer) const;
  double mean_neighbours() const;
};

template <class Test>
bool PackedLists::any(std::size_t i, const Test& test) const {
  const std::uint16_t *at = code.data() + first[i], *const end = code.data() + last[i];
  while (at != end) {
    const std::uint32_t base = at[0] | static_cast<std::uint32_t>(at[1]) << 16U;
    const std::uint16_t* const stop = at + 3 + at[2];
    for (at += 3; at != stop; ++at) {
      if (test(base + *at)) {
        return true;
      }
    }
  }
  return false;
}

/// Appends a list to `code`.
void append_packed(std::span<const std::uint32_t> entries, std::vector<std::uint16_t>& code);

/// The lists of make_neighbours().
PackedLists pack_neighbours(const Particles& particles, const std::vector<Ghost>& ghosts,
                            double reach);
NeighbourList unpacked(const PackedLists& lists);

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// Neighbour lists: who is within the kernel's support, in an order that belongs to the particle.
#pragma once

#include <cstdint>
#include <vector>

#include "solver/particles/ghosts.hpp"
#include "solver/particles/particles.hpp"

namespace meltproof::solver {

struct Points;
struct CellGrid;

/// A place in NeighbourList::index: half the size of a pointer, as there are two per particle.
using ListPlace = std::uint32_t;
/// The same of a count. @throws std::length_error from some 40 million particles on.
ListPlace list_place(std::size_t place);

/// For every particle the indices of its neighbours without itself: particles count from 0, ghosts
/// follow behind them, and the void record, which takes part in nothing, is the last index. Each
/// list is in the order of Particles::before(), that is in space-filling order, and padded with the
/// void to whole lanes. Only particles of this rank have one.
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

/// **Verlet lists of particles of which a few move.** A pair is listed up to `support` if both
/// stand still and up to `support + skin` if either may move, so lists stay right until the two
/// fastest particles together have moved by the skin. rebuild() remakes only the lists near moving
/// particles, and once more those that they have left; the others, which cannot have changed, stay.
class MovingNeighbours {
 public:
  /// @param support of the kernel, m; @param skin m.
  MovingNeighbours(double support, double skin) : support_(support), skin_(skin) {}

  /// Makes every list. @param mobile per particle, 1 if it moves or may begin to before the next
  /// rebuild.
  void build(const Particles& particles, const std::vector<Ghost>& ghosts,
             const std::vector<std::uint8_t>& mobile);
  /// Remakes the lists of the particles that have a mobile particle within reach, or had one when
  /// lists were last made. Indices must not have changed since build(), but that particles may have
  /// been added behind or have come to an entry that was free; with ghosts it makes every list.
  /// @param arrived from other ranks since the last call.
  void rebuild(const Particles& particles, const std::vector<Ghost>& ghosts,
               const std::vector<std::uint8_t>& mobile,
               const std::vector<std::uint32_t>& arrived = {});

  const NeighbourList& list() const { return list_; }
  double skin() const { return skin_; }
  /// The particles of this rank that had a mobile one within reach, or were mobile, when lists were
  /// last made.
  const std::vector<std::uint32_t>& near_moving() const { return remade_; }

 private:
  void make(const Particles& particles, const std::vector<Ghost>& ghosts,
            const std::vector<std::uint8_t>& mobile, const std::vector<std::uint32_t>& arrived,
            bool all);
  std::vector<std::uint8_t> find_touched(const Points& points, const CellGrid& grid,
                                         const std::vector<std::uint8_t>& mobile);

  double support_, skin_;
  NeighbourList list_;
  std::size_t kept_ = 0;               // entries of list_.index that the next rebuild() leaves
  std::vector<std::uint32_t> remade_;  // whose lists it remakes
};

/// A position that is outside the support of every kernel but whose distances stay finite, for the
/// void record.
inline constexpr double void_position = 1e30;

}  // namespace meltproof::solver

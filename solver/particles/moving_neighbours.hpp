// SPDX-License-Identifier: GPL-3.0-or-later
// The lists of a run: kept while nothing has moved far, remade near what moves.
#pragma once

#include <cstdint>
#include <vector>

#include "solver/particles/packed_lists.hpp"

namespace meltproof::solver {

struct Points;
struct CellGrid;

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

  const PackedLists& list() const { return list_; }
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
  PackedLists list_;
  std::size_t kept_ = 0;               // words of list_.code that the next rebuild() leaves
  std::vector<std::uint32_t> remade_;  // whose lists it remakes
};

}  // namespace meltproof::solver

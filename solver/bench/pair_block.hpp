// SPDX-License-Identifier: GPL-3.0-or-later
// The particles on which the pair loop is timed and tested.
#pragma once

#include <cstdint>
#include <vector>

#include "solver/bench/pair_loop.hpp"

namespace meltproof::solver {

/// A block of melt in space-filling order with lists and records.
struct PairBlock {
  double spacing = 0;                       ///< m
  QuinticSpline kernel;                     ///< h is the spacing
  NeighbourList list;                       ///< some 108 neighbours each, fewer at the faces
  std::vector<PairFields<double>> records;  ///< particles, then the void
  std::size_t size() const { return records.size() - 1; }
};

/// A cube of side^3 particles, spacing 10 um, each moved by up to a tenth of it: a disordered melt
/// whose fields vary over the block as in a pool (hundreds of kelvin, metres a second), with a
/// little noise from particle to particle. The same numbers at every call.
PairBlock make_pair_block(int side);

}  // namespace meltproof::solver

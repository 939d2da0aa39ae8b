// SPDX-License-Identifier: GPL-3.0-or-later
// The pair loop in single precision: relative coordinates and everything summed from them.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "solver/bench/pair_block.hpp"
#include "solver/bench/single_lanes.hpp"

namespace meltproof::solver {

/// A PairBlock as floats: one cache line a particle instead of two. Lengths in units of h, because
/// powers of h leave the range of floats. Places are in fixed point, and so are temperatures and
/// concentrations, of which only differences matter: those are as good between two particles far
/// from the origin as near it.
struct SingleBlock {
  static constexpr double place_step = 0x1p-22;          ///< h; up to 512 h from the centre
  static constexpr double temperature_step = 0x1p-18;    ///< K; up to 8192 K
  static constexpr double concentration_step = 0x1p-30;  ///< up to 1
  double h = 0;                                          ///< m
  NeighbourList list;                                    ///< padded to whole lanes of floats
  std::vector<PairFields<float>> records;                ///< particles, then the void
};

/// @throws InputError if the block is larger than its places in fixed point can tell.
SingleBlock to_single(const PairBlock& block);

/// The five terms as five_terms() computes them, in SI. Lanes are summed up in double precision.
void five_terms_single(const SingleBlock& block, std::vector<PairRates>& rates);

/// By how much `rates` differ from `exact`: root mean square of the difference over that of
/// `exact`, of the worst of the terms, and which that is.
struct Deviation {
  double worst = 0;
  std::string term;
  std::array<double, 4> of{};  ///< continuity, pressure and viscosity, heat, species
};
Deviation deviation(const std::vector<PairRates>& rates, const std::vector<PairRates>& exact);

}  // namespace meltproof::solver

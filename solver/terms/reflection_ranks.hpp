// SPDX-License-Identifier: GPL-3.0-or-later
// How several ranks follow reflected light together; only reflection.cpp includes this.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "solver/parallel/ranks.hpp"
#include "solver/particles/cell_grid.hpp"
#include "solver/terms/reflection_metal.hpp"

namespace meltproof::solver {

/// What rays left in which particles, W.
using Deposits = std::vector<std::pair<std::uint32_t, double>>;

/// Around all metal of all ranks, lost particles apart; collective.
Box box_of_metal(const Particles& particles, const Ranks& ranks);

/// **The metal that rays come by**, on every rank. Light reflected in a depression comes by a small
/// part of all metal, which nobody knows beforehand: rays begin without any, stop where they need a
/// block that is not there, and begin anew once all ranks have sent what they own in it. A ray that
/// has come to its end has met exactly what it would have met among all particles, in the same
/// cells and in the same order, so it ends in the same bits.
class SharedMetal {
 public:
  /// @param box of all metal. @param absorptivity of a particle of this rank.
  SharedMetal(const Particles& particles, const std::function<double(std::uint32_t)>& absorptivity,
              const Box& box, const Ranks& ranks);

  /// Those known, in the engine's order, and behind them two that span the box.
  const Particles& particles() const { return known_; }
  std::size_t count() const { return metal_.size(); }
  const MetalBlocks& blocks() const { return blocks_; }
  double absorptivity(std::uint32_t j) const { return metal_[j].absorptivity; }

  /// Brings all metal in these blocks and those that other ranks ask for. Collective.
  /// @returns whether any rank asked for any.
  bool fetch(std::vector<std::uint64_t> wanted);

  /// Notes what a ray of this rank left on its way; particles as known now.
  void keep(std::size_t ray, const Deposits& deposits);
  /// Calls add(particle, absorbed, here) for the deposits of all ranks, by ray and then along it,
  /// where `here` says that the particle is this rank's. Collective.
  void each_deposit(const std::function<void(std::uint32_t, double, bool)>& add) const;

 private:
  struct Piece {  // whole words, which ranks exchange
    Vector position;
    double absorptivity;
    std::int64_t identity;
    std::uint64_t order;
    std::uint32_t rank, index;  // of its owner, and there
  };
  struct Deposit {
    std::uint64_t ray;
    double absorbed;
    std::uint32_t rank, index;
  };

  const Particles& own_;
  std::function<double(std::uint32_t)> absorptivity_;
  Ranks ranks_;
  Box box_;
  MetalBlocks blocks_;
  std::vector<Piece> metal_;
  Particles known_;
  std::vector<Deposit> deposits_;
};

}  // namespace meltproof::solver

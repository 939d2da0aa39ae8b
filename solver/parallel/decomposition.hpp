// SPDX-License-Identifier: GPL-3.0-or-later
// Which rank owns which part of space.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "solver/parallel/ranks.hpp"
#include "solver/particles/particles.hpp"

namespace meltproof::solver {

/// **Boxes of equal cost**, by recursive coordinate bisection of the plan view (Zoltan): each rank
/// owns a column of space from the bottom to the sky. So light that comes from above meets all of a
/// column on one rank and its neighbours, and shadows need no exchange. The boxes fill space, their
/// outer faces lie at infinity.
class Decomposition {
 public:
  explicit Decomposition(const Ranks& ranks);
  ~Decomposition();
  Decomposition(Decomposition&&) noexcept;
  Decomposition& operator=(Decomposition&&) noexcept;

  /// What a particle costs in each part of a step, any unit. Ranks wait for each other between the
  /// parts, so each part of its own is to be spread evenly.
  using Cost = std::array<double, 3>;

  /// Before anything has been measured: the melt and what surrounds it costs by far the most.
  static Cost cost_at_first(Phase phase) { return {1, 1, phase == Phase::liquid ? 50.0 : 0.0}; }

  /// Makes new boxes, collectively. @param positions of particles of this rank, m, each particle on
  /// one rank. @returns what a step takes over what it would with all parts spread evenly.
  /// @throws std::runtime_error if Zoltan could not.
  double balance(std::span<const Vector> positions, std::span<const Cost> costs);

  /// What a step takes with ranks that wait for each other after each part, over what it would with
  /// all parts spread evenly; collective. @param own what this rank has to do in each part.
  static double unevenness(const Ranks& ranks, const Cost& own);

  /// The rank in whose box the point lies.
  int owner(const Vector& at) const;
  /// The ranks whose boxes come nearer to the point than `reach` along both axes, with the owner.
  void near(const Vector& at, double reach, std::vector<int>& found) const;

 private:
  struct Zoltan;
  Ranks ranks_;
  std::unique_ptr<Zoltan> zoltan_;
};

}  // namespace meltproof::solver

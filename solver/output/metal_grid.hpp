// SPDX-License-Identifier: GPL-3.0-or-later
// Where the metal is: the particles of a state in cells, for questions about places between them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "solver/particles/particles.hpp"

namespace meltproof::solver {

/// The solid and liquid particles inside a box, in cells of one spacing. Visits come in the order
/// of cells, and of identities within a cell: a sum over them does not depend on how the engine
/// keeps its particles.
class MetalGrid {
 public:
  /// Takes all particles that are neither gas nor lost and stand inside [lower, upper], m; the
  /// default box is without end. Keeps a reference to `particles`.
  explicit MetalGrid(const Particles& particles, const Vector& lower = everywhere(-1),
                     const Vector& upper = everywhere(1));

  static Vector everywhere(double sign) {
    Vector v;
    v.fill(sign * std::numeric_limits<double>::infinity());
    return v;
  }

  /// True if particle i is metal inside the box.
  bool holds(std::size_t i) const { return held_[i] != 0; }
  /// Indices of the held particles by increasing identity.
  const std::vector<std::uint32_t>& by_identity() const { return by_identity_; }
  const Vector& lower() const { return lower_; }  ///< m, of the held particles
  const Vector& upper() const { return upper_; }  ///< m, of the held particles

  /// Calls visit(j, r2) for every held particle within `reach` of `at`, m; r2 in m2.
  template <class Visit>
  void for_each_within(const Vector& at, double reach, const Visit& visit) const {
    if (by_identity_.empty()) {
      return;
    }
    std::array<std::size_t, 3> from{}, to{};
    for (std::size_t d = 0; d < 3; ++d) {
      const double low = std::floor((at[d] - reach - lower_[d]) / cell_);
      const double high = std::floor((at[d] + reach - lower_[d]) / cell_);
      if (!(high >= 0) || !(low < static_cast<double>(count_[d]))) {
        return;
      }
      from[d] = static_cast<std::size_t>(std::max(0.0, low));
      to[d] = static_cast<std::size_t>(std::min(high, static_cast<double>(count_[d] - 1)));
    }
    for (std::size_t z = from[2]; z <= to[2]; ++z) {
      for (std::size_t y = from[1]; y <= to[1]; ++y) {
        const std::size_t row = (z * count_[1] + y) * count_[0];
        for (std::size_t k = first_[row + from[0]]; k < first_[row + to[0] + 1]; ++k) {
          const std::uint32_t j = index_[k];
          const Vector& b = particles_.position[j];
          const double dx = at[0] - b[0], dy = at[1] - b[1], dz = at[2] - b[2];
          const double r2 = dx * dx + dy * dy + dz * dz;
          if (r2 <= reach * reach) {
            visit(j, r2);
          }
        }
      }
    }
  }

 private:
  std::array<std::size_t, 3> cell_of(const Vector& at) const;

  const Particles& particles_;
  double cell_ = 0;  ///< m
  Vector lower_{}, upper_{};
  std::array<std::size_t, 3> count_{1, 1, 1};
  std::vector<std::uint8_t> held_;
  std::vector<std::uint32_t> by_identity_, index_;
  std::vector<std::size_t> first_;
};

/// Distance from a held particle to the nearest other one, m; at most `reach`, which stands for
/// "none so near".
double nearest_distance(const MetalGrid& grid, const Particles& particles, std::size_t i,
                        double reach);

}  // namespace meltproof::solver

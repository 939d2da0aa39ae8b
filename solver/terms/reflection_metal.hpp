// SPDX-License-Identifier: GPL-3.0-or-later
// The metal that rays meet; only reflection.cpp and its parts include this.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "solver/particles/cell_grid.hpp"
#include "solver/particles/kernel.hpp"
#include "solver/terms/reflection.hpp"

namespace meltproof::solver {

/// A ray goes from hit to hit in steps of this many spacings, which are also half a cell.
constexpr double ray_stride = 0.75;

inline double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vector along(const Vector& from, double t, const Vector& d) {
  return {from[0] + t * d[0], from[1] + t * d[1], from[2] + t * d[2]};
}
inline Vector unit(const Vector& v) {
  const double size = std::sqrt(dot(v, v));
  return {v[0] / size, v[1] / size, v[2] / size};
}

/// **Blocks of metal**: the cells in which rays look for particles, four a side, and which of them
/// are known here. Where several ranks share the metal, none knows all of it.
struct MetalBlocks {
  static constexpr std::int64_t side = 4;  ///< cells

  /// @param box of all metal, of all ranks. @param cell its size, m.
  MetalBlocks(const Box& box, double cell) : lower(box.lower), size(cell) {
    for (std::size_t d = 0; d < 3; ++d) {
      cells[d] = 1 + static_cast<std::int64_t>((box.upper[d] - box.lower[d]) / size);
      count[d] = (cells[d] + side - 1) / side;
    }
    known.assign(static_cast<std::size_t>(count[0] * count[1] * count[2]), 0);
  }

  std::uint64_t of(const std::array<std::int64_t, 3>& cell) const {
    return static_cast<std::uint64_t>((cell[2] / side * count[1] + cell[1] / side) * count[0] +
                                      cell[0] / side);
  }
  /// Of a point in the box.
  std::uint64_t of(const Vector& at) const {
    std::array<std::int64_t, 3> cell{};
    for (std::size_t d = 0; d < 3; ++d) {
      cell[d] = static_cast<std::int64_t>((at[d] - lower[d]) / size);
    }
    return of(cell);
  }
  /// Whether all blocks that cells low to high lie in are known; those that are not are wanted.
  bool knows(const std::array<std::int64_t, 3>& low, const std::array<std::int64_t, 3>& high,
             std::vector<std::uint64_t>& wanted) const {
    bool all = true;
    for (std::int64_t z = low[2] / side; z <= high[2] / side; ++z) {
      for (std::int64_t y = low[1] / side; y <= high[1] / side; ++y) {
        for (std::int64_t x = low[0] / side; x <= high[0] / side; ++x) {
          const auto block = static_cast<std::uint64_t>((z * count[1] + y) * count[0] + x);
          if (known[block] == 0) {
            wanted.push_back(block);
            all = false;
          }
        }
      }
    }
    return all;
  }

  Vector lower;
  double size;  ///< m, of a cell
  std::array<std::int64_t, 3> cells{}, count{};
  std::vector<std::uint8_t> known;
};

/// The metal around the beam, for rays to meet.
class Metal {
 public:
  struct Hit {
    std::uint32_t particle = 0;
    Vector at{};
  };

  /// @param particles in the engine's order. @param count of them, those behind only span the grid.
  /// @param blocks null where all metal is known.
  Metal(const Particles& particles, std::size_t count, const Box& box, const QuinticSpline& kernel,
        const MetalBlocks* blocks)
      : position_(particles.position),
        count_(count),
        wide_(1.5 * kernel.smoothing_length, particles.dimensions),
        spacing_(particles.spacing),
        box_(box),
        blocks_(blocks),
        grid_(Points{particles, no_images}, 2 * ray_stride * particles.spacing,
              [&](std::size_t i) { return particles.phase[i] != Phase::lost; }) {
    box_.grow(2 * spacing_);
  }

  /// How far along a ray it enters the ball of a particle at c; nothing where it passes by or
  /// begins inside.
  std::optional<double> entry(const Vector& from, const Vector& d, const Vector& c) const {
    const Vector to{c[0] - from[0], c[1] - from[1], c[2] - from[2]};
    const double closest = dot(to, d), radius = ray_radius * spacing_;
    const double aside = dot(to, to) - closest * closest;
    if (aside >= radius * radius) {
      return {};
    }
    const double t = closest - std::sqrt(radius * radius - aside);
    return t > 0 ? std::optional(t) : std::nullopt;
  }

  /// Outward, at a point of the surface. @param otherwise where nothing is near. @param wanted
  /// blocks that are not known and might hold some of what is near: if any, there is no result.
  Vector normal(const Vector& at, const Vector& otherwise,
                std::vector<std::uint64_t>& wanted) const {
    Vector sum{};
    const double support = wide_.support();
    near(at, 3, wanted, [&](std::uint32_t j) {
      const Vector& c = position_[j];
      const Vector to{c[0] - at[0], c[1] - at[1], c[2] - at[2]};
      const double r = std::sqrt(dot(to, to));
      if (r > 0 && r < support) {
        // The slope is negative, so this points away from the metal.
        sum = along(sum, wide_.slope(r) / r, to);
      }
    });
    const double size = std::sqrt(dot(sum, sum));
    return size > 0 ? Vector{sum[0] / size, sum[1] / size, sum[2] / size} : otherwise;
  }

  /// The first particle on the way of a ray that leaves the surface at `from` with normal n.
  /// @param wanted as in normal(), with some of what lies ahead.
  std::optional<Hit> next(const Vector& from, const Vector& n, const Vector& d,
                          std::vector<std::uint64_t>& wanted) const {
    const double step = ray_stride * spacing_;
    const double own = 3 * spacing_;
    // Off the bumps of the lattice that it leaves.
    const Vector begin = along(from, 0.5 * spacing_, n);
    for (double t = 0;; t += step) {
      const Vector at = along(begin, t, d);
      if (!box_.holds(at)) {
        return {};
      }
      double first = std::numeric_limits<double>::infinity();
      std::uint32_t met = 0;
      near(at, 1, wanted, [&](std::uint32_t j) {
        const Vector& c = position_[j];
        const auto found = entry(begin, d, c);
        // Equally near ones: the smaller index, so that the order of looking does not matter.
        if (!found || *found > t + step || *found > first || (*found == first && j > met)) {
          return;
        }
        const Vector to{c[0] - from[0], c[1] - from[1], c[2] - from[2]};
        if (dot(to, to) < own * own && dot(to, n) < 0.25 * spacing_) {
          return;  // part of the surface that it leaves
        }
        first = *found;
        met = j;
      });
      if (!wanted.empty()) {
        // A block at a time would cost a round among all ranks for each.
        for (int ahead = 1; ahead <= 3; ++ahead) {
          const double farther = MetalBlocks::side * grid_.size * ahead;
          near(along(begin, t + farther, d), 1, wanted, [](std::uint32_t) {});
        }
        return {};
      }
      if (first < std::numeric_limits<double>::infinity()) {
        return Hit{met, along(begin, first, d)};
      }
    }
  }

 private:
  template <class Visit>
  void near(const Vector& at, std::int64_t around, std::vector<std::uint64_t>& wanted,
            const Visit& visit) const {
    std::array<std::int64_t, 3> low{}, high{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto c = static_cast<std::int64_t>(std::floor((at[k] - grid_.lower[k]) / grid_.size));
      low[k] = std::max<std::int64_t>(0, c - around);
      high[k] = std::min(grid_.count[k] - 1, c + around);
      if (low[k] > high[k]) {
        return;
      }
    }
    if (blocks_ != nullptr && !blocks_->knows(low, high, wanted)) {
      return;
    }
    for (std::int64_t z = low[2]; z <= high[2]; ++z) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        const std::size_t from = grid_.cell({low[0], y, z}), to = grid_.cell({high[0], y, z});
        for (std::uint32_t k = grid_.first[from]; k < grid_.first[to + 1]; ++k) {
          if (grid_.member[k] < count_) {
            visit(grid_.member[k]);
          }
        }
      }
    }
  }

  static inline const std::vector<Ghost> no_images{};
  const std::vector<Vector>& position_;
  std::size_t count_;
  // The steps of a lattice turn normals by up to 14 degrees with the smoothing length of everything
  // else, on a wall of 60 degrees; by 9 with 1.5 times that, by 0.4 on one of 27.
  QuinticSpline wide_;
  double spacing_;
  Box box_;  // a ray that leaves it meets nothing any more
  const MetalBlocks* blocks_;
  CellGrid grid_;
};

}  // namespace meltproof::solver

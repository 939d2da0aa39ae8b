// SPDX-License-Identifier: GPL-3.0-or-later
// Points in the cells of a regular grid, to find who is near.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "solver/particles/ghosts.hpp"
#include "solver/particles/particles.hpp"

namespace meltproof::solver {

/// Places of particles and, behind them, of their images.
struct Points {
  const Particles& particles;
  const std::vector<Ghost>& ghosts;

  std::size_t size() const { return particles.size() + ghosts.size(); }
  const Vector& operator[](std::size_t i) const {
    return i < particles.size() ? particles.position[i] : ghosts[i - particles.size()].position;
  }
  /// False of a free entry.
  bool there(std::size_t i) const {
    return i >= particles.size() || particles.home[i] != Home::nowhere;
  }
};

/// A box in space, m; empty until something is added.
struct Box {
  Vector lower = filled(std::numeric_limits<double>::infinity());
  Vector upper = filled(-std::numeric_limits<double>::infinity());

  static Vector filled(double value) { return {value, value, value}; }
  void add(const Vector& at) {
    for (std::size_t d = 0; d < 3; ++d) {
      lower[d] = std::min(lower[d], at[d]);
      upper[d] = std::max(upper[d], at[d]);
    }
  }
  void grow(double margin) {
    for (std::size_t d = 0; d < 3; ++d) {
      lower[d] -= margin;
      upper[d] += margin;
    }
  }
  bool holds(const Vector& at) const {
    bool inside = true;
    for (std::size_t d = 0; d < 3; ++d) {
      inside = inside && at[d] >= lower[d] && at[d] <= upper[d];
    }
    return inside;
  }
};

/// Points counted into the cells of a regular grid.
struct CellGrid {
  Vector lower{};
  std::array<std::int64_t, 3> count{1, 1, 1};
  double size = 0;  ///< m, of a cell
  std::vector<std::uint32_t> first, member;

  /// Of those points for which `chosen(i)` holds.
  template <class Chosen>
  CellGrid(const Points& points, double cell_size, const Chosen& chosen) : size(cell_size) {
    Box box;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (chosen(i)) {
        box.add(points[i]);
        member.push_back(static_cast<std::uint32_t>(i));
      }
    }
    if (!member.empty()) {
      lower = box.lower;
      for (std::size_t d = 0; d < 3; ++d) {
        count[d] = 1 + static_cast<std::int64_t>((box.upper[d] - box.lower[d]) / size);
      }
    }
    first.assign(cells() + 1, 0);
    std::vector<std::uint32_t> place(member.size());
    for (std::size_t m = 0; m < member.size(); ++m) {
      place[m] = static_cast<std::uint32_t>(cell(of(points[member[m]])));
      ++first[place[m] + 1];
    }
    for (std::size_t c = 1; c < first.size(); ++c) {
      first[c] += first[c - 1];
    }
    std::vector<std::uint32_t> next(first), sorted(member.size());
    for (std::size_t m = 0; m < member.size(); ++m) {
      sorted[next[place[m]]++] = member[m];
    }
    member = std::move(sorted);
  }
  std::size_t cells() const { return static_cast<std::size_t>(count[0] * count[1] * count[2]); }
  std::array<std::int64_t, 3> of(const Vector& p) const {
    std::array<std::int64_t, 3> c{};
    for (std::size_t d = 0; d < 3; ++d) {
      c[d] = static_cast<std::int64_t>((p[d] - lower[d]) / size);
    }
    return c;
  }
  std::size_t cell(const std::array<std::int64_t, 3>& c) const {
    return static_cast<std::size_t>((c[2] * count[1] + c[1]) * count[0] + c[0]);
  }
  /// Calls visit(j) for the members of the cell of `p`, which must be inside the grid, and the
  /// cells around it.
  template <class Visit>
  void around(const Vector& p, const Visit& visit) const {
    const auto mine = of(p);
    for (std::int64_t cz = std::max<std::int64_t>(0, mine[2] - 1);
         cz <= std::min(count[2] - 1, mine[2] + 1); ++cz) {
      for (std::int64_t cy = std::max<std::int64_t>(0, mine[1] - 1);
           cy <= std::min(count[1] - 1, mine[1] + 1); ++cy) {
        // Cells along x follow each other in memory, so three of them are one run.
        const std::size_t low = cell({std::max<std::int64_t>(0, mine[0] - 1), cy, cz}),
                          high = cell({std::min(count[0] - 1, mine[0] + 1), cy, cz});
        for (std::uint32_t k = first[low]; k < first[high + 1]; ++k) {
          visit(member[k]);
        }
      }
    }
  }
};

/// m2
inline double squared_distance(const Vector& a, const Vector& b) {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z;
}

}  // namespace meltproof::solver

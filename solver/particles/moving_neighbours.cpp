// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/particles/moving_neighbours.hpp"

#include <algorithm>
#include <utility>

#include "solver/particles/cell_grid.hpp"
#include "solver/particles/list_making.hpp"
#include "solver/particles/loops.hpp"

namespace meltproof::solver {

void MovingNeighbours::build(const Particles& particles, const std::vector<Ghost>& ghosts,
                             const std::vector<std::uint8_t>& mobile) {
  list_.code.clear();
  list_.first.assign(particles.size(), 0);
  list_.last.assign(particles.size(), 0);
  list_.reach = support_ + skin_;
  remade_.clear();
  kept_ = 0;
  make(particles, ghosts, mobile, {}, true);
}

void MovingNeighbours::rebuild(const Particles& particles, const std::vector<Ghost>& ghosts,
                               const std::vector<std::uint8_t>& mobile,
                               const std::vector<std::uint32_t>& arrived) {
  if (!ghosts.empty()) {
    // Images come and go, and with them the indices in everybody's list.
    build(particles, ghosts, mobile);
    return;
  }
  list_.first.resize(particles.size(), 0);
  list_.last.resize(particles.size(), 0);
  make(particles, ghosts, mobile, arrived, false);
}

/// Who has a mobile particle within reach, or is one. @param mobile of points; @param grid of all
/// who may have.
std::vector<std::uint8_t> MovingNeighbours::find_touched(const Points& points, const CellGrid& grid,
                                                         const std::vector<std::uint8_t>& mobile) {
  const double far = (support_ + skin_) * (support_ + skin_);
  // Mobile points cell by cell, and whether a cell or one beside it has any.
  std::vector<std::uint32_t> begin(grid.cells() + 1, 0), movers;
  for (std::size_t c = 0; c < grid.cells(); ++c) {
    for (std::uint32_t k = grid.first[c]; k < grid.first[c + 1]; ++k) {
      if (mobile[grid.member[k]] != 0) {
        movers.push_back(grid.member[k]);
      }
    }
    begin[c + 1] = static_cast<std::uint32_t>(movers.size());
  }
  std::vector<std::uint8_t> touched(points.particles.size(), 0);
  for_each_particle(grid.member.size(), [&](std::size_t m) {
    const std::uint32_t i = grid.member[m];
    if (i >= touched.size() || points.particles.home[i] != Home::here) {
      return;
    }
    if (mobile[i] != 0) {
      touched[i] = 1;
      return;
    }
    const Vector& at = points[i];
    const auto mine = grid.of(at);
    for (std::int64_t z = std::max<std::int64_t>(0, mine[2] - 1);
         z <= std::min(grid.count[2] - 1, mine[2] + 1); ++z) {
      for (std::int64_t y = std::max<std::int64_t>(0, mine[1] - 1);
           y <= std::min(grid.count[1] - 1, mine[1] + 1); ++y) {
        const std::size_t low = grid.cell({std::max<std::int64_t>(0, mine[0] - 1), y, z}),
                          high = grid.cell({std::min(grid.count[0] - 1, mine[0] + 1), y, z});
        for (std::uint32_t k = begin[low]; k < begin[high + 1]; ++k) {
          if (squared_distance(at, points[movers[k]]) < far) {
            touched[i] = 1;
            return;
          }
        }
      }
    }
  });
  return touched;
}

void MovingNeighbours::make(const Particles& particles, const std::vector<Ghost>& ghosts,
                            const std::vector<std::uint8_t>& mobile,
                            const std::vector<std::uint32_t>& arrived, bool all) {
  const double reach = support_ + skin_;
  const Points points{particles, ghosts};
  const std::size_t n = particles.size();
  list_.void_index = static_cast<std::uint32_t>(points.size());
  // Only what is near somebody who moves, or did when the lists were last made, counts.
  Box box;
  if (!all) {
    for (std::size_t i = 0; i < n; ++i) {
      if (mobile[i] != 0 && points.there(i)) {
        box.add(points[i]);
      }
    }
    box.grow(reach);
    for (const auto* indices : {&std::as_const(remade_), &arrived}) {
      for (const std::uint32_t i : *indices) {
        box.add(points[i]);
      }
    }
    box.grow(reach);
  }
  const CellGrid grid(points, reach, [&](std::size_t i) {
    return points.there(i) && (all || box.holds(points[i]));
  });
  ListLimits limits{.near = support_ * support_, .far = reach * reach, .moving = mobile};
  for (const auto& ghost : ghosts) {
    limits.moving.push_back(mobile[ghost.source]);
  }
  const std::vector<std::uint8_t> touched = find_touched(points, grid, limits.moving);
  // Whoever is left behind by the melt gets a last list, which then stays.
  std::vector<std::uint8_t> left(n, all ? 1 : 0);
  for (const auto* indices : {&std::as_const(remade_), &arrived}) {
    for (const std::uint32_t i : *indices) {
      left[i] = 1;
    }
  }
  std::vector<std::uint32_t> settled;
  remade_.clear();
  for (std::uint32_t i = 0; i < n; ++i) {
    if (particles.home[i] != Home::here) {
      // Nobody sums over the neighbours of a copy.
      list_.first[i] = list_.last[i] = 0;
    } else if (touched[i] != 0) {
      remade_.push_back(i);
    } else if (left[i] != 0) {
      settled.push_back(i);
    }
  }
  const ListOrder order(particles);
  list_.code.resize(kept_);
  append_lists(list_, grid, order, points, settled, limits);
  kept_ = list_.code.size();
  append_lists(list_, grid, order, points, remade_, limits);
}

}  // namespace meltproof::solver

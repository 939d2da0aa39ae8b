// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/particles/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "solver/particles/block_sum.hpp"
#include "solver/particles/lanes.hpp"

namespace meltproof::solver {
namespace {

/// Points counted into the cells of a regular grid.
struct CellGrid {
  Vector lower{};
  std::array<std::int64_t, 3> count{1, 1, 1};
  double size = 0;
  std::vector<std::uint32_t> first, member;

  CellGrid(const std::vector<Vector>& points, double cell_size) : size(cell_size) {
    Vector upper{};
    lower.fill(std::numeric_limits<double>::infinity());
    upper.fill(-std::numeric_limits<double>::infinity());
    for (const auto& p : points) {
      for (std::size_t d = 0; d < 3; ++d) {
        lower[d] = std::min(lower[d], p[d]);
        upper[d] = std::max(upper[d], p[d]);
      }
    }
    for (std::size_t d = 0; d < 3; ++d) {
      count[d] = 1 + static_cast<std::int64_t>((upper[d] - lower[d]) / size);
    }
    first.assign(static_cast<std::size_t>(count[0] * count[1] * count[2]) + 1, 0);
    for (const auto& p : points) {
      ++first[cell(of(p)) + 1];
    }
    for (std::size_t c = 1; c < first.size(); ++c) {
      first[c] += first[c - 1];
    }
    auto next = first;
    member.resize(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      member[next[cell(of(points[i]))]++] = i;
    }
  }
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
  /// Calls visit(j) for the members of the cell of `p` and the cells around it.
  template <class Visit>
  void around(const Vector& p, const Visit& visit) const {
    const auto home = of(p);
    for (std::int64_t cz = std::max<std::int64_t>(0, home[2] - 1);
         cz <= std::min(count[2] - 1, home[2] + 1); ++cz) {
      for (std::int64_t cy = std::max<std::int64_t>(0, home[1] - 1);
           cy <= std::min(count[1] - 1, home[1] + 1); ++cy) {
        // Cells along x follow each other in memory, so three of them are one run.
        const std::size_t low = cell({std::max<std::int64_t>(0, home[0] - 1), cy, cz}),
                          high = cell({std::min(count[0] - 1, home[0] + 1), cy, cz});
        for (std::uint32_t k = first[low]; k < first[high + 1]; ++k) {
          visit(member[k]);
        }
      }
    }
  }
};

std::vector<Vector> all_points(const Particles& particles, const std::vector<Ghost>& ghosts) {
  std::vector<Vector> points(particles.position);
  for (const auto& ghost : ghosts) {
    points.push_back(ghost.position);
  }
  return points;
}

double squared_distance(const Vector& a, const Vector& b) {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z;
}

/// Appends the lists of `members` to list.index. Blocks are built apart and joined, so that the
/// result does not depend on the number of threads. @param listed (i, j, squared distance) -> bool.
template <class Listed>
void append_lists(NeighbourList& list, const CellGrid& grid, const std::vector<Vector>& points,
                  const std::vector<std::uint32_t>& members, const Listed& listed) {
  constexpr std::int64_t block = 256;
  const auto n = static_cast<std::int64_t>(members.size());
  const std::int64_t blocks = (n + block - 1) / block;
  std::vector<std::vector<std::uint32_t>> part(static_cast<std::size_t>(blocks));
#pragma omp parallel for schedule(dynamic, 1)
  for (std::int64_t b = 0; b < blocks; ++b) {
    auto& out = part[static_cast<std::size_t>(b)];
    out.reserve(static_cast<std::size_t>(block) * 128);
    for (std::int64_t at = b * block; at < std::min(n, (b + 1) * block); ++at) {
      const std::uint32_t i = members[static_cast<std::size_t>(at)];
      const std::size_t begin = out.size();
      grid.around(points[i], [&](std::uint32_t j) {
        if (j != i && listed(i, j, squared_distance(points[i], points[j]))) {
          out.push_back(j);
        }
      });
      std::sort(out.begin() + static_cast<std::ptrdiff_t>(begin), out.end());
      while ((out.size() - begin) % lane_count != 0) {
        out.push_back(list.void_index);
      }
      list.first[i] = begin;  // within the block, for now
      list.last[i] = out.size();
    }
  }
  for (std::int64_t b = 0; b < blocks; ++b) {
    const std::size_t offset = list.index.size();
    const auto& out = part[static_cast<std::size_t>(b)];
    list.index.insert(list.index.end(), out.begin(), out.end());
    for (std::int64_t at = b * block; at < std::min(n, (b + 1) * block); ++at) {
      const std::uint32_t i = members[static_cast<std::size_t>(at)];
      list.first[i] += offset;
      list.last[i] += offset;
    }
  }
}

}  // namespace

double NeighbourList::mean_neighbours() const {
  std::size_t real = 0;
  for (std::size_t i = 0; i < last.size(); ++i) {
    for (std::size_t k = first[i]; k < last[i]; ++k) {
      real += index[k] != void_index ? 1U : 0U;
    }
  }
  return last.empty() ? 0 : static_cast<double>(real) / static_cast<double>(last.size());
}

NeighbourList make_neighbours(const Particles& particles, const std::vector<Ghost>& ghosts,
                              double reach) {
  const std::vector<Vector> points = all_points(particles, ghosts);
  const CellGrid grid(points, reach);
  NeighbourList list;
  list.reach = reach;
  list.void_index = static_cast<std::uint32_t>(points.size());
  list.first.assign(particles.size() + 1, 0);
  list.last.assign(particles.size(), 0);
  std::vector<std::uint32_t> everyone(particles.size());
  std::iota(everyone.begin(), everyone.end(), 0U);
  append_lists(list, grid, points, everyone,
               [&](std::uint32_t, std::uint32_t, double r2) { return r2 < reach * reach; });
  list.first.back() = list.index.size();
  return list;
}

void MovingNeighbours::build(const Particles& particles, const std::vector<Ghost>& ghosts,
                             const std::vector<std::uint8_t>& mobile) {
  list_.index.clear();
  list_.first.assign(particles.size() + 1, 0);
  list_.last.assign(particles.size(), 0);
  list_.reach = support_ + skin_;
  make(particles, ghosts, mobile, true);
}

void MovingNeighbours::rebuild(const Particles& particles, const std::vector<Ghost>& ghosts,
                               const std::vector<std::uint8_t>& mobile) {
  // Images come and go, and with them the indices in everybody's list.
  make(particles, ghosts, mobile, !ghosts.empty());
}

void MovingNeighbours::make(const Particles& particles, const std::vector<Ghost>& ghosts,
                            const std::vector<std::uint8_t>& mobile, bool all) {
  const double near = support_ * support_, far = (support_ + skin_) * (support_ + skin_);
  const std::vector<Vector> points = all_points(particles, ghosts);
  const std::size_t n = particles.size();
  std::vector<std::uint8_t> moves(mobile);
  for (const auto& ghost : ghosts) {
    moves.push_back(mobile[ghost.source]);
  }
  const CellGrid grid(points, support_ + skin_);
  list_.void_index = static_cast<std::uint32_t>(points.size());
  if (all) {
    kept_ = 0;
    touched_.assign(n, 0);
  }
  for_each_particle(points.size(), [&](std::size_t i) {
    if (moves[i] == 0) {
      return;
    }
    grid.around(points[i], [&](std::uint32_t j) {
      if (j < n && squared_distance(points[i], points[j]) < far) {
#pragma omp atomic write
        touched_[j] = 1;
      }
    });
  });
  remade_.clear();
  for (std::uint32_t i = 0; i < n; ++i) {
    if (all || touched_[i] != 0) {
      remade_.push_back(i);
    }
  }
  list_.index.resize(kept_);
  append_lists(list_, grid, points, remade_, [&](std::uint32_t i, std::uint32_t j, double r2) {
    return r2 < near || (r2 < far && (moves[i] != 0 || moves[j] != 0));
  });
  if (all) {
    kept_ = list_.index.size();
  }
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/particles/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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
};

}  // namespace

double NeighbourList::mean_neighbours() const {
  const auto real =
      std::count_if(index.begin(), index.end(), [&](std::uint32_t j) { return j != void_index; });
  return first.size() > 1 ? static_cast<double>(real) / static_cast<double>(first.size() - 1) : 0;
}

NeighbourList make_neighbours(const Particles& particles, const std::vector<Ghost>& ghosts,
                              double reach) {
  std::vector<Vector> points(particles.position);
  for (const auto& ghost : ghosts) {
    points.push_back(ghost.position);
  }
  const CellGrid grid(points, reach);
  const auto n = static_cast<std::int64_t>(particles.size());
  NeighbourList list;
  list.reach = reach;
  list.void_index = static_cast<std::uint32_t>(points.size());
  list.first.assign(particles.size() + 1, 0);
  // Blocks are built apart and joined, so that the result does not depend on the number of threads.
  constexpr std::int64_t block = 512;
  const std::int64_t blocks = (n + block - 1) / block;
  std::vector<std::vector<std::uint32_t>> part(static_cast<std::size_t>(blocks));
#pragma omp parallel for schedule(dynamic, 1)
  for (std::int64_t b = 0; b < blocks; ++b) {
    auto& out = part[static_cast<std::size_t>(b)];
    for (std::int64_t at = b * block; at < std::min(n, (b + 1) * block); ++at) {
      const auto i = static_cast<std::size_t>(at);
      const std::size_t begin = out.size();
      const auto home = grid.of(points[i]);
      for (std::int64_t cz = std::max<std::int64_t>(0, home[2] - 1);
           cz <= std::min(grid.count[2] - 1, home[2] + 1); ++cz) {
        for (std::int64_t cy = std::max<std::int64_t>(0, home[1] - 1);
             cy <= std::min(grid.count[1] - 1, home[1] + 1); ++cy) {
          for (std::int64_t cx = std::max<std::int64_t>(0, home[0] - 1);
               cx <= std::min(grid.count[0] - 1, home[0] + 1); ++cx) {
            const std::size_t c = grid.cell({cx, cy, cz});
            for (std::uint32_t k = grid.first[c]; k < grid.first[c + 1]; ++k) {
              const std::uint32_t j = grid.member[k];
              const double x = points[i][0] - points[j][0], y = points[i][1] - points[j][1],
                           z = points[i][2] - points[j][2];
              if (j != i && x * x + y * y + z * z < reach * reach) {
                out.push_back(j);
              }
            }
          }
        }
      }
      std::sort(out.begin() + static_cast<std::ptrdiff_t>(begin), out.end());
      while ((out.size() - begin) % lane_count != 0) {
        out.push_back(list.void_index);
      }
      list.first[i + 1] = out.size() - begin;
    }
  }
  for (std::size_t i = 1; i < list.first.size(); ++i) {
    list.first[i] += list.first[i - 1];
  }
  list.index.reserve(list.first.back());
  for (const auto& piece : part) {
    list.index.insert(list.index.end(), piece.begin(), piece.end());
  }
  return list;
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/particles/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "solver/particles/loops.hpp"
#include "solver/particles/lanes.hpp"

namespace meltproof::solver {
namespace {

/// Points counted into the cells of a regular grid.
struct CellGrid {
  Vector lower{};
  std::array<std::int64_t, 3> count{1, 1, 1};
  double size = 0;
  std::vector<std::uint32_t> first, member;

  /// @param home of the first points; the rest are all there.
  CellGrid(const std::vector<Vector>& points, const std::vector<Home>& home, double cell_size)
      : size(cell_size) {
    const auto there = [&](std::size_t i) { return i >= home.size() || home[i] != Home::nowhere; };
    Vector upper{};
    lower.fill(std::numeric_limits<double>::infinity());
    upper.fill(-std::numeric_limits<double>::infinity());
    std::size_t present = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (there(i)) {
        ++present;
        for (std::size_t d = 0; d < 3; ++d) {
          lower[d] = std::min(lower[d], points[i][d]);
          upper[d] = std::max(upper[d], points[i][d]);
        }
      }
    }
    for (std::size_t d = 0; d < 3 && present > 0; ++d) {
      count[d] = 1 + static_cast<std::int64_t>((upper[d] - lower[d]) / size);
    }
    first.assign(static_cast<std::size_t>(count[0] * count[1] * count[2]) + 1, 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (there(i)) {
        ++first[cell(of(points[i])) + 1];
      }
    }
    for (std::size_t c = 1; c < first.size(); ++c) {
      first[c] += first[c - 1];
    }
    auto next = first;
    member.resize(present);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      if (there(i)) {
        member[next[cell(of(points[i]))]++] = i;
      }
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

/// The order in which neighbours stand in lists: particles by Particles::before(), images behind
/// them by index. Indices follow it up to the first particle that came from another rank since the
/// last sort.
struct ListOrder {
  const Particles& particles;
  std::uint32_t alike = 0;  ///< below this index, order and index are the same

  explicit ListOrder(const Particles& p) : particles(p) {
    const auto n = static_cast<std::uint32_t>(p.size());
    while (alike < n && (alike == 0 || p.before(alike - 1, alike))) {
      ++alike;
    }
    if (alike == n) {
      alike = std::numeric_limits<std::uint32_t>::max();
    }
  }
  bool operator()(std::uint32_t a, std::uint32_t b) const {
    const auto n = static_cast<std::uint32_t>(particles.size());
    return a < n && b < n ? particles.before(a, b) : a < b;
  }
  void sort(std::vector<std::uint32_t>& indices) const {
    std::sort(indices.begin(), indices.end());
    const auto rest = std::lower_bound(indices.begin(), indices.end(), alike);
    if (rest != indices.end()) {
      std::sort(rest, indices.end(), *this);
      std::inplace_merge(indices.begin(), rest, indices.end(), *this);
    }
  }
};

/// Everybody who may be a neighbour of the members of one cell, in order, so that the lists come
/// out sorted without a sort of each; coordinates apart, so that distances are taken in lanes.
struct Candidates {
  std::vector<std::uint32_t> index;
  std::vector<double> x, y, z, limit, squared;

  /// Those near the box around all of `members`: a quarter to a half fewer than all around the
  /// cell.
  void gather(const CellGrid& grid, const ListOrder& order, const std::vector<Vector>& points,
              const std::vector<double>& limits, const std::vector<std::uint32_t>& members) {
    Vector low = points[members.front()], high = low;
    for (const std::uint32_t i : members) {
      for (std::size_t d = 0; d < 3; ++d) {
        low[d] = std::min(low[d], points[i][d]);
        high[d] = std::max(high[d], points[i][d]);
      }
    }
    const double reach = grid.size * grid.size;
    index.clear();
    grid.around(low, [&](std::uint32_t j) {
      double squared_gap = 0;
      for (std::size_t d = 0; d < 3; ++d) {
        const double gap = std::max({0.0, low[d] - points[j][d], points[j][d] - high[d]});
        squared_gap += gap * gap;
      }
      if (squared_gap < reach) {
        index.push_back(j);
      }
    });
    order.sort(index);
    const std::size_t n = index.size();
    for (auto* field : {&x, &y, &z, &limit, &squared}) {
      field->resize(n);
    }
    for (std::size_t k = 0; k < n; ++k) {
      const Vector& at = points[index[k]];
      x[k] = at[0];
      y[k] = at[1];
      z[k] = at[2];
      limit[k] = limits[index[k]];
    }
  }

  /// Appends the neighbours of particle i: nearer than the larger of the two limits.
  void append(std::uint32_t i, const Vector& at, double own_limit,
              std::vector<std::uint32_t>& out) {
    const std::size_t n = index.size(), begin = out.size();
    for (std::size_t k = 0; k < n; ++k) {
      const double dx = at[0] - x[k], dy = at[1] - y[k], dz = at[2] - z[k];
      squared[k] = dx * dx + dy * dy + dz * dz;
    }
    // Written always and counted if it belongs there: no branch to be guessed wrong.
    out.resize(begin + n + 1);
    std::size_t end = begin;
    for (std::size_t k = 0; k < n; ++k) {
      out[end] = index[k];
      end += squared[k] < std::max(own_limit, limit[k]) && index[k] != i ? 1U : 0U;
    }
    out.resize(end);
  }
};

/// Appends the lists of `members`, in increasing order, to list.index: cell by cell, then joined in
/// the members' order, so that the result does not depend on the number of threads.
/// @param limits per point, m2: two points are neighbours below the larger of theirs.
void append_lists(NeighbourList& list, const CellGrid& grid, const ListOrder& order,
                  const std::vector<Vector>& points, const std::vector<std::uint32_t>& members,
                  const std::vector<double>& limits) {
  // The members of each cell that has any.
  std::vector<std::uint32_t> count(grid.first.size(), 0), cells;
  std::vector<std::uint32_t> home(members.size());
  for (std::size_t m = 0; m < members.size(); ++m) {
    home[m] = static_cast<std::uint32_t>(grid.cell(grid.of(points[members[m]])));
    if (count[home[m]]++ == 0) {
      cells.push_back(home[m]);
    }
  }
  std::vector<std::vector<std::uint32_t>> inside(cells.size()), part(cells.size());
  for (std::uint32_t c = 0; c < cells.size(); ++c) {
    inside[c].reserve(count[cells[c]]);
    count[cells[c]] = c;
  }
  for (std::size_t m = 0; m < members.size(); ++m) {
    home[m] = count[home[m]];
    inside[home[m]].push_back(members[m]);
  }
#pragma omp parallel
  {
    Candidates candidates;
#pragma omp for schedule(dynamic, 1)
    for (std::size_t c = 0; c < cells.size(); ++c) {
      auto& out = part[c];
      candidates.gather(grid, order, points, limits, inside[c]);
      for (const std::uint32_t i : inside[c]) {
        const std::size_t begin = out.size();
        candidates.append(i, points[i], limits[i], out);
        while ((out.size() - begin) % lane_count != 0) {
          out.push_back(list.void_index);
        }
        list.first[i] = begin;  // within the cell, for now
        list.last[i] = out.size();
      }
    }
  }
  std::size_t end = list.index.size();
  std::vector<std::size_t> within(members.size());
  for (std::size_t m = 0; m < members.size(); ++m) {
    const std::uint32_t i = members[m];
    const std::size_t length = list.last[i] - list.first[i];
    within[m] = list.first[i];
    list.first[i] = end;
    end += length;
    list.last[i] = end;
  }
  list.index.resize(end);
  for_each_particle(members.size(), [&](std::size_t m) {
    const std::uint32_t i = members[m];
    const auto from = part[home[m]].begin() + static_cast<std::ptrdiff_t>(within[m]);
    std::copy(from, from + static_cast<std::ptrdiff_t>(list.last[i] - list.first[i]),
              list.index.begin() + static_cast<std::ptrdiff_t>(list.first[i]));
  });
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
  const CellGrid grid(points, particles.home, reach);
  NeighbourList list;
  list.reach = reach;
  list.void_index = static_cast<std::uint32_t>(points.size());
  list.first.assign(particles.size() + 1, 0);
  list.last.assign(particles.size(), 0);
  std::vector<std::uint32_t> everyone(particles.size());
  std::iota(everyone.begin(), everyone.end(), 0U);
  append_lists(list, grid, ListOrder(particles), points, everyone,
               std::vector<double>(points.size(), reach * reach));
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
                               const std::vector<std::uint8_t>& mobile,
                               const std::vector<std::uint32_t>& arrived) {
  const std::size_t n = particles.size();
  list_.first.resize(n + 1, 0);
  list_.last.resize(n, 0);
  touched_.resize(n, 0);
  for (const std::uint32_t i : arrived) {
    touched_[i] = 1;
  }
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
  const CellGrid grid(points, particles.home, support_ + skin_);
  list_.void_index = static_cast<std::uint32_t>(points.size());
  if (all) {
    kept_ = 0;
    touched_.assign(n, 0);
  }
  for_each_particle(points.size(), [&](std::size_t i) {
    if (moves[i] == 0 || (i < n && particles.home[i] == Home::nowhere)) {
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
    if (particles.home[i] != Home::here) {
      // Nobody sums over the neighbours of a copy.
      list_.first[i] = list_.last[i] = 0;
    } else if (all || touched_[i] != 0) {
      remade_.push_back(i);
    }
  }
  list_.index.resize(kept_);
  std::vector<double> limits(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    limits[i] = moves[i] != 0 ? far : near;
  }
  append_lists(list_, grid, ListOrder(particles), points, remade_, limits);
  if (all) {
    kept_ = list_.index.size();
  }
}

}  // namespace meltproof::solver

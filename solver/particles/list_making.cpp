// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/particles/list_making.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "solver/particles/lanes.hpp"
#include "solver/particles/loops.hpp"

namespace meltproof::solver {

ListOrder::ListOrder(const Particles& p) : particles(p) {
  const auto n = static_cast<std::uint32_t>(p.size());
  while (alike < n && (alike == 0 || p.before(alike - 1, alike))) {
    ++alike;
  }
  if (alike == n) {
    alike = std::numeric_limits<std::uint32_t>::max();
  }
}

bool ListOrder::operator()(std::uint32_t a, std::uint32_t b) const {
  const auto n = static_cast<std::uint32_t>(particles.size());
  return a < n && b < n ? particles.before(a, b) : a < b;
}

void ListOrder::sort(std::vector<std::uint32_t>& indices) const {
  std::sort(indices.begin(), indices.end());
  const auto rest = std::lower_bound(indices.begin(), indices.end(), alike);
  if (rest != indices.end()) {
    std::sort(rest, indices.end(), *this);
    std::inplace_merge(indices.begin(), rest, indices.end(), *this);
  }
}

namespace {

// Lists that are made at a time: until they are joined they stand in memory twice.
constexpr std::size_t block = 8192;

/// Everybody who may be a neighbour of the members of one cell, in order, so that the lists come
/// out sorted without a sort of each; coordinates apart, so that distances are taken in lanes.
struct Candidates {
  std::vector<std::uint32_t> index, found;
  Coordinates place;
  std::vector<double> limit;

  /// Those near the box around all of `members`: a quarter to a half fewer than all around the
  /// cell.
  void gather(const CellGrid& grid, const ListOrder& order, const Points& points,
              const ListLimits& limits, std::span<const std::uint32_t> members) {
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
    for (auto* field : {&place.x, &place.y, &place.z, &limit}) {
      field->resize(n);
    }
    for (std::size_t k = 0; k < n; ++k) {
      const Vector& at = points[index[k]];
      place.x[k] = at[0];
      place.y[k] = at[1];
      place.z[k] = at[2];
      limit[k] = limits[index[k]];
    }
  }

  /// Appends the neighbours of particle i: nearer than the larger of the two limits.
  void append(std::uint32_t i, const Vector& at, double own_limit,
              std::vector<std::uint16_t>& code) {
    found.resize(std::max(found.size(), index.size() + 8));
    const std::size_t n = candidates_within(at, own_limit, place, limit.data(), index.data(),
                                            index.size(), i, found.data());
    append_packed({found.data(), n}, code);
  }
};

/// The lists of a block of members, appended to list.code.
void append_block(PackedLists& list, const CellGrid& grid, const ListOrder& order,
                  const Points& points, std::span<const std::uint32_t> members,
                  const ListLimits& limits) {
  // Members by cell, in their order within each.
  std::vector<std::uint32_t> home(members.size()), sorted(members.size());
  for (std::size_t m = 0; m < members.size(); ++m) {
    home[m] = static_cast<std::uint32_t>(grid.cell(grid.of(points[members[m]])));
  }
  std::iota(sorted.begin(), sorted.end(), 0U);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return home[a] < home[b]; });
  std::vector<std::uint32_t> begins, inside(members.size());
  for (std::uint32_t m = 0; m < sorted.size(); ++m) {
    inside[m] = members[sorted[m]];
    if (m == 0 || home[sorted[m]] != home[sorted[m - 1]]) {
      begins.push_back(m);
    }
  }
  begins.push_back(static_cast<std::uint32_t>(sorted.size()));
  const std::size_t cells = begins.size() - 1;
  std::vector<std::vector<std::uint16_t>> part(cells);
#pragma omp parallel
  {
    Candidates candidates;
#pragma omp for schedule(dynamic, 1)
    for (std::size_t c = 0; c < cells; ++c) {
      const std::span<const std::uint32_t> of_cell(inside.data() + begins[c],
                                                   begins[c + 1] - begins[c]);
      auto& out = part[c];
      candidates.gather(grid, order, points, limits, of_cell);
      for (const std::uint32_t i : of_cell) {
        const std::size_t begin = out.size();
        candidates.append(i, points[i], limits[i], out);
        list.first[i] = static_cast<ListPlace>(begin);  // within the cell, for now
        list.last[i] = static_cast<ListPlace>(out.size());
      }
    }
  }
  // Joined in the members' order, so that the result does not depend on the number of threads.
  std::vector<std::uint32_t> cell_of(members.size());
  for (std::uint32_t c = 0; c < cells; ++c) {
    for (std::uint32_t m = begins[c]; m < begins[c + 1]; ++m) {
      cell_of[sorted[m]] = c;
    }
  }
  std::size_t end = list.code.size();
  std::vector<std::size_t> within(members.size());
  for (std::size_t m = 0; m < members.size(); ++m) {
    const std::uint32_t i = members[m];
    const std::size_t length = list.last[i] - list.first[i];
    within[m] = list.first[i];
    list.first[i] = static_cast<ListPlace>(end);
    end += length;
    list.last[i] = list_place(end);
  }
  if (end > list.code.capacity()) {
    // Twice as much would be memory that is never used.
    list.code.reserve(end + end / 16);
  }
  list.code.resize(end);
  for_each_particle(members.size(), [&](std::size_t m) {
    const std::uint32_t i = members[m];
    const auto from = part[cell_of[m]].begin() + static_cast<std::ptrdiff_t>(within[m]);
    std::copy(from, from + static_cast<std::ptrdiff_t>(list.last[i] - list.first[i]),
              list.code.begin() + static_cast<std::ptrdiff_t>(list.first[i]));
  });
}

}  // namespace

void append_lists(PackedLists& list, const CellGrid& grid, const ListOrder& order,
                  const Points& points, std::span<const std::uint32_t> members,
                  const ListLimits& limits) {
  const std::size_t before = list.code.size();
  for (std::size_t begin = 0; begin < members.size(); begin += block) {
    append_block(list, grid, order, points,
                 members.subspan(begin, std::min(block, members.size() - begin)), limits);
    if (begin == 0 && members.size() > block) {
      // All at once rather than bit by bit, which copies what there is; what is not used of it
      // stays with the system.
      const std::size_t each = (list.code.size() - before) / block + 16;
      list.code.reserve(before + members.size() * (each + each / 4));
    }
  }
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/particles/neighbours.hpp"

#include <limits>
#include <numeric>
#include <stdexcept>

#include "solver/particles/cell_grid.hpp"
#include "solver/particles/list_making.hpp"
#include "solver/particles/packed_lists.hpp"

namespace meltproof::solver {

double NeighbourList::mean_neighbours() const {
  std::size_t real = 0;
  for (std::size_t i = 0; i < last.size(); ++i) {
    for (std::size_t k = first[i]; k < last[i]; ++k) {
      real += index[k] != void_index ? 1U : 0U;
    }
  }
  return last.empty() ? 0 : static_cast<double>(real) / static_cast<double>(last.size());
}

ListPlace list_place(std::size_t place) {
  if (place > std::numeric_limits<ListPlace>::max()) {
    throw std::length_error(
        "the neighbour lists of one rank have more than 2^32 entries: start more ranks (mpirun "
        "-n)");
  }
  return static_cast<ListPlace>(place);
}

PackedLists pack_neighbours(const Particles& particles, const std::vector<Ghost>& ghosts,
                            double reach) {
  const Points points{particles, ghosts};
  const CellGrid grid(points, reach, [&](std::size_t i) { return points.there(i); });
  PackedLists lists;
  lists.reach = reach;
  lists.void_index = static_cast<std::uint32_t>(points.size());
  lists.first.assign(particles.size(), 0);
  lists.last.assign(particles.size(), 0);
  std::vector<std::uint32_t> everyone(particles.size());
  std::iota(everyone.begin(), everyone.end(), 0U);
  append_lists(lists, grid, ListOrder(particles), points, everyone,
               {.near = reach * reach, .far = 0, .moving = {}});
  return lists;
}

NeighbourList make_neighbours(const Particles& particles, const std::vector<Ghost>& ghosts,
                              double reach) {
  return unpacked(pack_neighbours(particles, ghosts, reach));
}

}  // namespace meltproof::solver

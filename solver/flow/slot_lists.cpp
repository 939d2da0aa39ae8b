// SPDX-License-Identifier: GPL-3.0-or-later
// The lists of melt and walls, by slots.
#include <algorithm>

#include "solver/flow/free_surface.hpp"
#include "solver/particles/loops.hpp"

namespace meltproof::solver {

/// The flow's lists: those of melt and walls, entry by entry, so that sums keep their order.
void FreeSurfaceFlow::translate_lists(const PackedLists& list) {
  list_.reach = list.reach;
  const auto place = [](NeighbourList& lists, const std::vector<std::uint32_t>& lengths) {
    lists.first.resize(lengths.size());
    lists.last.resize(lengths.size());
    std::size_t end = 0;
    for (std::size_t k = 0; k < lengths.size(); ++k) {
      lists.first[k] = list_place(end);
      end += (lengths[k] + lane_count - 1) / lane_count * lane_count;
      lists.last[k] = list_place(end);
    }
    lists.index.resize(end);
  };
  std::vector<std::uint32_t> lengths(particle_.size());
  for_each_particle(lengths.size(), [&](std::size_t s) {
    lengths[s] = static_cast<std::uint32_t>(list.count(particle_[s]));  // nothing of copies
  });
  place(list_, lengths);
  for_each_sum(particle_.size(), [&](std::size_t s) {
    thread_local ListBuffer buffer;
    const auto entries = list.of(particle_[s], buffer);
    std::transform(
        entries.begin(), entries.end(),
        list_.index.begin() + static_cast<std::ptrdiff_t>(list_.first[s]),
        [&](std::uint32_t j) { return slot_[j] == nowhere ? list_.void_index : slot_[j]; });
  });
  // A wall listens to the melt only, which is a small part of its list.
  std::vector<std::uint8_t> is_melt(list_.void_index + std::size_t{1} + behind_walls_.size(), 0);
  for_each_particle(particle_.size(),
                    [&](std::size_t s) { is_melt[s] = role_[particle_[s]] == 1 ? 1 : 0; });
  const auto melt_of = [&](std::size_t k, const auto& visit) {
    const std::uint32_t s = slot_[wall_[k]];
    for (std::size_t e = list_.first[s]; e < list_.last[s]; ++e) {
      visit(list_.index[e], is_melt[list_.index[e]]);
    }
  };
  lengths.assign(wall_.size(), 0);
  for_each_sum(wall_.size(), [&](std::size_t k) {
    melt_of(k, [&](std::uint32_t, std::uint8_t melt) { lengths[k] += melt; });
  });
  place(melt_near_wall_, lengths);
  for_each_sum(wall_.size(), [&](std::size_t k) {
    thread_local std::vector<std::uint32_t> found;
    found.resize(lengths[k] + std::size_t{1});
    // Written always and counted if it belongs there: no branch to be guessed wrong.
    std::size_t n = 0;
    melt_of(k, [&](std::uint32_t slot, std::uint8_t melt) {
      found[n] = slot;
      n += melt;
    });
    const auto begin =
        melt_near_wall_.index.begin() + static_cast<std::ptrdiff_t>(melt_near_wall_.first[k]);
    const auto end =
        melt_near_wall_.index.begin() + static_cast<std::ptrdiff_t>(melt_near_wall_.last[k]);
    std::fill(std::copy_n(found.begin(), n, begin), end, list_.void_index);
  });
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// Which neighbours are within the kernel's support at this moment.
#include <algorithm>
#include <array>

#include "solver/flow/free_surface.hpp"
#include "solver/flow/separation.hpp"

namespace meltproof::solver {

/// As much as the whole lists of the melt take: near_ never allocates within a step.
void FreeSurfaceFlow::make_room_for_near() {
  near_.void_index = list_.void_index;
  near_.first.clear();
  std::size_t end = 0;
  for (const std::uint32_t i : liquid_slot_) {
    near_.first.push_back(list_place(end));
    end += list_.last[i] - list_.first[i];
  }
  near_.last = near_.first;
  near_.index.resize(end);
}

/// Two fifths of what a Verlet list names lie in its skin, beyond the support, where every summand
/// is exactly zero. They are left out here once for all passes that follow at the same places. What
/// stays keeps its lane and its order there, so the sums of each lane, and with them all results,
/// are the same to the bit as over the whole list.
void FreeSurfaceFlow::find_near() {
  const MotionRecord* all = motion_.data();
  // A little more than the square of the support: what rounding leaves in doubt stays.
  near_.reach = kernel_.support() * (1 + 1e-9);
  const Lane limit = near_.reach * near_.reach;
  for_each_sum(liquid_slot_.size(), [&](std::size_t member) {
    const std::uint32_t i = liquid_slot_[member];
    const MotionRecord& own = all[i];
    std::uint32_t* out = &near_.index[near_.first[member]];
    std::array<std::uint32_t, lane_count> length{};  // entries of each lane, times lane_count
    for (std::size_t k = list_.first[i]; k < list_.last[i]; k += lane_count) {
      const std::uint32_t* j = &list_.index[k];
      const Lane dx = own.x - gather(all, j, &MotionRecord::x);
      const Lane dy = own.y - gather(all, j, &MotionRecord::y);
      const Lane dz = own.z - gather(all, j, &MotionRecord::z);
      const auto within = dx * dx + dy * dy + dz * dz < limit;
      // Written always and counted if it belongs there: no branch to be guessed wrong.
      for (std::size_t lane = 0; lane < lane_count; ++lane) {
        out[length[lane] + lane] = j[lane];
        length[lane] += within[lane] ? static_cast<std::uint32_t>(lane_count) : 0U;
      }
    }
    const std::uint32_t longest = *std::max_element(length.begin(), length.end());
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      for (std::uint32_t k = length[lane]; k < longest; k += lane_count) {
        out[k + lane] = near_.void_index;
      }
    }
    near_.last[member] = near_.first[member] + longest;
  });
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/terms/conduction.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>

#include "solver/particles/cell_grid.hpp"
#include "solver/particles/loops.hpp"

namespace meltproof::solver {

namespace {

/// Cells as large as the lists reach, marked where somebody is awake, there or next to it: most of
/// the metal sleeps far from that, and need not look through its list.
class AwakeCells {
 public:
  AwakeCells(const std::vector<HeatRecord>& records, double reach) : size_(reach) {
    Box box;
    for (const HeatRecord& r : records) {
      if (r.awake > 0 && r.x < void_position) {
        box.add({r.x, r.y, r.z});
      }
    }
    if (!(box.lower[0] <= box.upper[0])) {
      return;
    }
    for (std::size_t d = 0; d < 3; ++d) {
      lower_[d] = box.lower[d] - size_;
      count_[d] = 3 + static_cast<std::size_t>((box.upper[d] - box.lower[d]) / size_);
    }
    marked_.assign(count_[0] * count_[1] * count_[2], 0);
    for (const HeatRecord& r : records) {
      if (r.awake > 0 && r.x < void_position) {
        marked_[*cell(r)] = 1;
      }
    }
    spread(1, count_[0]);
    spread(count_[0], count_[1]);
    spread(count_[0] * count_[1], count_[2]);
  }
  bool near(const HeatRecord& r) const {
    const auto c = cell(r);
    return c && marked_[*c] != 0;
  }

 private:
  std::optional<std::size_t> cell(const HeatRecord& r) const {
    const std::array<double, 3> at{(r.x - lower_[0]) / size_, (r.y - lower_[1]) / size_,
                                   (r.z - lower_[2]) / size_};
    for (std::size_t d = 0; d < 3; ++d) {
      if (!(at[d] >= 0 && at[d] < static_cast<double>(count_[d]))) {
        return {};
      }
    }
    return (static_cast<std::size_t>(at[2]) * count_[1] + static_cast<std::size_t>(at[1])) *
               count_[0] +
           static_cast<std::size_t>(at[0]);
  }
  /// To both neighbours along one axis, whose cells are `stride` apart.
  void spread(std::size_t stride, std::size_t count) {
    const std::vector<std::uint8_t> before = marked_;
    for (std::size_t c = 0; c < marked_.size(); ++c) {
      const std::size_t place = c / stride % count;
      const bool marked = before[c] != 0 || (place > 0 && before[c - stride] != 0) ||
                          (place + 1 < count && before[c + stride] != 0);
      marked_[c] = marked ? 1 : 0;
    }
  }

  double size_;
  Vector lower_{};
  std::array<std::size_t, 3> count_{0, 0, 0};
  std::vector<std::uint8_t> marked_;
};

}  // namespace

void find_awake(const std::vector<HeatRecord>& records, const PackedLists& neighbours,
                std::vector<std::uint32_t>& active) {
  const std::size_t n = neighbours.last.size();
  std::vector<std::uint8_t> involved(n, 0);
  const AwakeCells cells(records, neighbours.reach);
  for_each_particle(n, [&](std::size_t i) {
    if (records[i].awake > 0) {
      involved[i] = 1;
      return;
    }
    if (!cells.near(records[i])) {
      return;
    }
    involved[i] = neighbours.any(i, [&](std::uint32_t j) { return records[j].awake > 0; }) ? 1 : 0;
  });
  active.clear();
  for (std::uint32_t i = 0; i < n; ++i) {
    if (involved[i] != 0) {
      active.push_back(i);
    }
  }
}

namespace {

/// The exchange of one particle with as many others as there are lanes, W m-3.
[[gnu::always_inline]] inline Lane exchange(const HeatRecord& own, const HeatFields<Lane>& other,
                                            const QuinticSpline& kernel) {
  const Lane dx = own.x - other.x, dy = own.y - other.y, dz = own.z - other.z;
  const Lane exchanged = conduction_pair(Lane(own.conductivity), Lane(own.temperature),
                                         other.conductivity, other.temperature, other.volume,
                                         kernel.gradient_factor(dx * dx + dy * dy + dz * dz));
  return where_positive(own.awake + other.awake, exchanged, Lane(0.0));
}

}  // namespace

void conduct(const std::vector<HeatRecord>& records, const PackedLists& neighbours,
             const QuinticSpline& kernel, const std::vector<std::uint32_t>& active,
             std::vector<double>& power) {
  const HeatRecord* all = records.data();
  std::fill(power.begin(), power.end(), 0.0);
  for_each_sum(active.size(), [&](std::size_t member) {
    const std::uint32_t i = active[member];
    const HeatRecord own = all[i];
    thread_local ListBuffer buffer;
    const auto list = neighbours.of(i, buffer);
    Lane sum = 0;
    for (std::size_t k = 0; k < list.size(); k += lane_count) {
      sum += exchange(own, gather_records<HeatFields>(all, &list[k]), kernel);
    }
    power[i] = sum_lanes(sum);
  });
}

void conduct_apart(const std::vector<HeatRecord>& records, const PackedLists& neighbours,
                   const QuinticSpline& kernel, const std::vector<std::uint32_t>& members,
                   std::vector<double>& from_fast, std::vector<double>* from_slow) {
  const HeatRecord* all = records.data();
  for_each_sum(members.size(), [&](std::size_t member) {
    const std::uint32_t i = members[member];
    const HeatRecord own = all[i];
    thread_local ListBuffer buffer;
    const auto list = neighbours.of(i, buffer);
    Lane fast = 0, slow = 0;
    for (std::size_t k = 0; k < list.size(); k += lane_count) {
      const auto other = gather_records<HeatFields>(all, &list[k]);
      const Lane exchanged = exchange(own, other, kernel);
      fast += where_positive(other.pace - 1.5, Lane(0.0),
                             where_positive(other.pace, exchanged, Lane(0.0)));
      slow += where_positive(other.pace, Lane(0.0), exchanged);
    }
    from_fast[i] = sum_lanes(fast);
    if (from_slow != nullptr) {
      (*from_slow)[i] = sum_lanes(slow);
    }
  });
}

void conduct_with(const std::vector<HeatRecord>& records, const PackedLists& neighbours,
                  const QuinticSpline& kernel, const std::vector<std::uint32_t>& members,
                  std::uint8_t lowest, std::uint8_t highest, double* power) {
  const HeatRecord* all = records.data();
  const Lane above = lowest - 0.5, below = highest + 0.5;
  for_each_sum(members.size(), [&](std::size_t member) {
    const std::uint32_t i = members[member];
    const HeatRecord own = all[i];
    thread_local ListBuffer buffer;
    const auto list = neighbours.of(i, buffer);
    Lane sum = 0;
    for (std::size_t k = 0; k < list.size(); k += lane_count) {
      const auto other = gather_records<HeatFields>(all, &list[k]);
      const Lane within =
          where_positive(below - other.pace, exchange(own, other, kernel), Lane(0.0));
      sum += where_positive(other.pace - above, within, Lane(0.0));
    }
    power[member] = sum_lanes(sum);
  });
}

void conduct(const std::vector<HeatRecord>& records, const PackedLists& neighbours,
             const QuinticSpline& kernel, std::vector<double>& power) {
  std::vector<std::uint32_t> everyone(power.size());
  std::iota(everyone.begin(), everyone.end(), 0U);
  conduct(records, neighbours, kernel, everyone, power);
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/terms/conduction.hpp"

#include <algorithm>
#include <numeric>

#include "solver/particles/loops.hpp"

namespace meltproof::solver {

void find_awake(const std::vector<HeatRecord>& records, const NeighbourList& neighbours,
                std::vector<std::uint32_t>& active) {
  const std::size_t n = neighbours.last.size();
  std::vector<std::uint8_t> involved(n, 0);
  for_each_particle(n, [&](std::size_t i) {
    if (records[i].awake > 0) {
      involved[i] = 1;
      return;
    }
    for (std::size_t k = neighbours.first[i]; k < neighbours.last[i]; ++k) {
      if (records[neighbours.index[k]].awake > 0) {
        involved[i] = 1;
        return;
      }
    }
  });
  active.clear();
  for (std::uint32_t i = 0; i < n; ++i) {
    if (involved[i] != 0) {
      active.push_back(i);
    }
  }
}

void conduct(const std::vector<HeatRecord>& records, const NeighbourList& neighbours,
             const QuinticSpline& kernel, const std::vector<std::uint32_t>& active,
             std::vector<double>& power) {
  const HeatRecord* all = records.data();
  std::fill(power.begin(), power.end(), 0.0);
  for_each_particle(active.size(), [&](std::size_t member) {
    const std::uint32_t i = active[member];
    const HeatRecord& own = all[i];
    const Lane x = own.x, y = own.y, z = own.z, temperature = own.temperature,
               conductivity = own.conductivity;
    Lane sum = 0;
    for (std::size_t k = neighbours.first[i]; k < neighbours.last[i]; k += lane_count) {
      const std::uint32_t* j = &neighbours.index[k];
      const Lane dx = x - gather(all, j, &HeatRecord::x);
      const Lane dy = y - gather(all, j, &HeatRecord::y);
      const Lane dz = z - gather(all, j, &HeatRecord::z);
      const Lane exchanged = conduction_pair(
          conductivity, temperature, gather(all, j, &HeatRecord::conductivity),
          gather(all, j, &HeatRecord::temperature), gather(all, j, &HeatRecord::volume),
          kernel.gradient_factor(dx * dx + dy * dy + dz * dz));
      sum += where_positive(own.awake + gather(all, j, &HeatRecord::awake), exchanged, Lane(0.0));
    }
    power[i] = sum_lanes(sum);
  });
}

void conduct(const std::vector<HeatRecord>& records, const NeighbourList& neighbours,
             const QuinticSpline& kernel, std::vector<double>& power) {
  std::vector<std::uint32_t> everyone(power.size());
  std::iota(everyone.begin(), everyone.end(), 0U);
  conduct(records, neighbours, kernel, everyone, power);
}

}  // namespace meltproof::solver

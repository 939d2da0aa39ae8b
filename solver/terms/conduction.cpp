// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/terms/conduction.hpp"

#include "solver/particles/block_sum.hpp"

namespace meltproof::solver {

void conduct(const std::vector<HeatRecord>& records, const NeighbourList& neighbours,
             const QuinticSpline& kernel, std::vector<double>& power) {
  const HeatRecord* all = records.data();
  for_each_particle(power.size(), [&](std::size_t i) {
    const HeatRecord& own = all[i];
    const Lane x = own.x, y = own.y, z = own.z, temperature = own.temperature,
               conductivity = own.conductivity;
    Lane sum = 0;
    for (std::size_t k = neighbours.first[i]; k < neighbours.last[i]; k += lane_count) {
      const std::uint32_t* j = &neighbours.index[k];
      const Lane dx = x - gather(all, j, &HeatRecord::x);
      const Lane dy = y - gather(all, j, &HeatRecord::y);
      const Lane dz = z - gather(all, j, &HeatRecord::z);
      sum += conduction_pair(conductivity, temperature, gather(all, j, &HeatRecord::conductivity),
                             gather(all, j, &HeatRecord::temperature),
                             gather(all, j, &HeatRecord::volume),
                             kernel.gradient_factor(dx * dx + dy * dy + dz * dz));
    }
    power[i] = sum_lanes(sum);
  });
}

}  // namespace meltproof::solver

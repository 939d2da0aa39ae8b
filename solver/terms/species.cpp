// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/terms/species.hpp"

#include <array>

#include "solver/particles/loops.hpp"

namespace meltproof::solver {

void diffuse(const SpeciesRecords& all, const PackedLists& neighbours, const QuinticSpline& kernel,
             SpeciesFactor factor, const std::vector<std::uint32_t>& members,
             std::vector<double>& rate) {
  const SpeciesRecord* records = all.records.data();
  const double weight = factor == SpeciesFactor::consistent ? 2.0 : 4.0;
  rate.resize(members.size());
  for_each_sum(members.size(), [&](std::size_t member) {
    const std::uint32_t i = members[member];
    const SpeciesRecord& own = records[all.place[i]];
    const Lane x = own.x, y = own.y, z = own.z, diffusivity = own.diffusivity,
               density = own.density, concentration = own.concentration;
    Lane sum = 0;
    std::array<std::uint32_t, lane_count> places;
    thread_local ListBuffer buffer;
    const auto list = neighbours.of(i, buffer);
    for (std::size_t k = 0; k < list.size(); k += lane_count) {
      for (std::size_t lane = 0; lane < lane_count; ++lane) {
        places[lane] = all.place[list[k + lane]];
      }
      const auto other = gather_records<SpeciesFields>(records, places.data());
      const Lane dx = x - other.x, dy = y - other.y, dz = z - other.z;
      sum += species_pair(diffusivity, density, concentration, other.diffusivity, other.density,
                          other.concentration, other.volume,
                          kernel.gradient_factor(dx * dx + dy * dy + dz * dz), weight);
    }
    rate[member] = sum_lanes(sum) / own.density;
  });
}

}  // namespace meltproof::solver

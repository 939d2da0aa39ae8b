// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/terms/species.hpp"

#include "solver/particles/loops.hpp"

namespace meltproof::solver {

void diffuse(const std::vector<SpeciesRecord>& records, const NeighbourList& neighbours,
             const QuinticSpline& kernel, SpeciesFactor factor,
             const std::vector<std::uint32_t>& active, std::vector<double>& rate) {
  const SpeciesRecord* all = records.data();
  const double weight = factor == SpeciesFactor::consistent ? 2.0 : 4.0;
  for_each_particle(active.size(), [&](std::size_t a) {
    const std::size_t i = active[a];
    const SpeciesRecord& own = all[i];
    const Lane x = own.x, y = own.y, z = own.z, diffusivity = own.diffusivity,
               density = own.density, concentration = own.concentration;
    Lane sum = 0;
    for (std::size_t k = neighbours.first[i]; k < neighbours.last[i]; k += lane_count) {
      const std::uint32_t* j = &neighbours.index[k];
      const Lane dx = x - gather(all, j, &SpeciesRecord::x);
      const Lane dy = y - gather(all, j, &SpeciesRecord::y);
      const Lane dz = z - gather(all, j, &SpeciesRecord::z);
      sum += species_pair(
          diffusivity, density, concentration, gather(all, j, &SpeciesRecord::diffusivity),
          gather(all, j, &SpeciesRecord::density), gather(all, j, &SpeciesRecord::concentration),
          gather(all, j, &SpeciesRecord::volume),
          kernel.gradient_factor(dx * dx + dy * dy + dz * dz), weight);
    }
    rate[i] = sum_lanes(sum) / own.density;
  });
}

}  // namespace meltproof::solver

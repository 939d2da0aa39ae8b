// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/terms/surface_conduction.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "solver/particles/loops.hpp"
#include "solver/terms/interface.hpp"

namespace meltproof::solver {
namespace {

/// Distances and F from a particle to a lane of its neighbours.
struct Pair {
  Lane dx, dy, dz, square, factor;
};

template <class Body>
void for_each_pair(const std::vector<HeatRecord>& records, const PackedLists& neighbours,
                   const QuinticSpline& kernel, std::size_t i, const Body& body) {
  const HeatRecord* all = records.data();
  const HeatRecord& own = all[i];
  const Lane x = own.x, y = own.y, z = own.z;
  thread_local ListBuffer buffer;
  const auto list = neighbours.of(i, buffer);
  for (std::size_t k = 0; k < list.size(); k += lane_count) {
    const std::uint32_t* j = &list[k];
    Pair pair;
    pair.dx = x - gather(all, j, &HeatRecord::x);
    pair.dy = y - gather(all, j, &HeatRecord::y);
    pair.dz = z - gather(all, j, &HeatRecord::z);
    pair.square = pair.dx * pair.dx + pair.dy * pair.dy + pair.dz * pair.dz;
    pair.factor = kernel.gradient_factor(pair.square);
    body(j, pair);
  }
}

Lane share_of(const SurfaceRecord& own, const SurfaceRecord* all, const std::uint32_t* j,
              const Pair& pair) {
  return surface_share(pair.dx, pair.dy, pair.dz, Lane(1.0) / (pair.square + 1e-300),
                       Lane(own.gain), Lane(own.nx), Lane(own.ny), Lane(own.nz),
                       gather(all, j, &SurfaceRecord::gain), gather(all, j, &SurfaceRecord::nx),
                       gather(all, j, &SurfaceRecord::ny), gather(all, j, &SurfaceRecord::nz));
}

}  // namespace

void SurfaceConduction::update(const std::vector<HeatRecord>& records,
                               const std::vector<Ghost>& ghosts, const PackedLists& neighbours,
                               const QuinticSpline& kernel,
                               const std::vector<std::uint32_t>* among) {
  const std::size_t n = neighbours.last.size();
  const HeatRecord* all = records.data();
  std::vector<std::uint32_t> everybody;
  if (among == nullptr) {
    everybody.resize(n);
    std::iota(everybody.begin(), everybody.end(), 0U);
    among = &everybody;
    outer_.assign(n, 0);
    takes_part_.assign(n, 0);
    surface_.clear();
  }
  surface_.resize(records.size());
  surface_.back() = {};  // the void
  for_each_sum(among->size(), [&](std::size_t m) {
    const std::uint32_t i = (*among)[m];
    Lane x = 0, y = 0, z = 0;
    for_each_pair(records, neighbours, kernel, i, [&](const std::uint32_t* j, const Pair& pair) {
      const Lane weight = gather(all, j, &HeatRecord::volume) * pair.factor;
      x += weight * pair.dx;
      y += weight * pair.dy;
      z += weight * pair.dz;
    });
    const double gx = sum_lanes(x), gy = sum_lanes(y), gz = sum_lanes(z);
    const double size = std::sqrt(gx * gx + gy * gy + gz * gz);
    outer_[i] = size * kernel.smoothing_length > interface_threshold ? 1 : 0;
    surface_[i] =
        outer_[i] != 0 ? SurfaceRecord{0, -gx / size, -gy / size, -gz / size} : SurfaceRecord{};
  });
  std::vector<std::uint32_t> members;
  std::copy_if(among->begin(), among->end(), std::back_inserter(members),
               [&](std::uint32_t i) { return outer_[i] != 0; });
  const auto refresh_images = [&] {
    for (std::size_t g = 0; g < ghosts.size(); ++g) {
      const SurfaceRecord& source = surface_[ghosts[g].source];
      const Vector normal = ghosts[g].mirrored({source.nx, source.ny, source.nz});
      surface_[n + g] = {source.gain, normal[0], normal[1], normal[2]};
    }
  };
  std::vector<double> gain(members.size());
  for (int sweep = 0; sweep < 6; ++sweep) {
    refresh_images();
    for_each_sum(members.size(), [&](std::size_t m) {
      const std::uint32_t i = members[m];
      const SurfaceRecord own = surface_[i];
      const SurfaceRecord along{1, own.nx, own.ny, own.nz};
      Lane moment = 0, stiffness = 0;
      for_each_pair(records, neighbours, kernel, i, [&](const std::uint32_t* j, const Pair& pair) {
        const Lane across = pair.dx * along.nx + pair.dy * along.ny + pair.dz * along.nz;
        const Lane tangential = pair.square - across * across;
        const Lane weight = -0.5 * gather(all, j, &HeatRecord::volume) * pair.factor * tangential;
        moment += weight * (1.0 + share_of(own, surface_.data(), j, pair));
        // As if all neighbours' gains rose with this one: half of that would overshoot.
        stiffness += weight * tangential / (pair.square + 1e-300);
      });
      const double still = sum_lanes(stiffness);
      gain[m] = still > 0 ? std::clamp(own.gain + (1 - sum_lanes(moment)) / still, smallest_gain,
                                       largest_gain)
                          : 0;
    });
    for (std::size_t m = 0; m < members.size(); ++m) {
      surface_[members[m]].gain = gain[m];
    }
  }
  refresh_images();
  // Receivers: whoever has a particle with a gain among its neighbours.
  for_each_sum(among->size(), [&](std::size_t m) {
    const std::uint32_t i = (*among)[m];
    const auto gains = [&](std::uint32_t j) { return surface_[j].gain != 0; };
    takes_part_[i] = surface_[i].gain != 0 || neighbours.any(i, gains) ? 1 : 0;
  });
}

void SurfaceConduction::add(const std::vector<HeatRecord>& records, const PackedLists& neighbours,
                            const QuinticSpline& kernel, const std::vector<std::uint32_t>& active,
                            std::vector<double>& power) const {
  const HeatRecord* all = records.data();
  for_each_sum(active.size(), [&](std::size_t m) {
    const std::uint32_t i = active[m];
    if (takes_part_[i] == 0) {
      return;
    }
    const SurfaceRecord& own = surface_[i];
    const Lane conductivity = all[i].conductivity, temperature = all[i].temperature,
               awake = all[i].awake;
    Lane sum = 0;
    for_each_pair(records, neighbours, kernel, i, [&](const std::uint32_t* j, const Pair& pair) {
      const Lane exchanged =
          share_of(own, surface_.data(), j, pair) *
          conduction_pair(conductivity, temperature, gather(all, j, &HeatRecord::conductivity),
                          gather(all, j, &HeatRecord::temperature),
                          gather(all, j, &HeatRecord::volume), pair.factor);
      sum += where_positive(awake + gather(all, j, &HeatRecord::awake), exchanged, Lane(0.0));
    });
    power[i] += sum_lanes(sum);
  });
}

}  // namespace meltproof::solver

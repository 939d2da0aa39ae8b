// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/melt_pool.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace meltproof::solver {
namespace {

/// Calls visit(j) for each neighbour of i that touches it. Images behind the domain's faces do not
/// count.
template <class Visit>
void for_each_touching(const Particles& particles, const PackedLists& list, std::uint32_t i,
                       const Visit& visit) {
  const double touch = touching * particles.spacing;
  list.each(i, [&](std::uint32_t j) {
    if (j >= particles.size()) {
      return;
    }
    const auto& a = particles.position[i];
    const auto& b = particles.position[j];
    const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    if (x * x + y * y + z * z < touch * touch) {
      visit(j);
    }
  });
}

/// Of the connected regions where `level` is not negative, the one of the largest volume; the first
/// one of equal ones. Not the one around the hottest particle: that may be spray.
std::vector<std::uint32_t> largest_region(const Particles& particles, const PackedLists& list,
                                          const std::vector<double>& level) {
  std::vector<bool> seen(particles.size(), false);
  std::vector<std::uint32_t> largest, region;
  double largest_volume = 0;
  for (std::uint32_t seed = 0; seed < particles.size(); ++seed) {
    if (seen[seed] || !(level[seed] >= 0)) {
      continue;
    }
    region.assign(1, seed);
    seen[seed] = true;
    double volume = 0;
    for (std::size_t at = 0; at < region.size(); ++at) {
      volume += particles.volume[region[at]];
      for_each_touching(particles, list, region[at], [&](std::uint32_t j) {
        if (!seen[j] && level[j] >= 0) {
          seen[j] = true;
          region.push_back(j);
        }
      });
    }
    if (volume > largest_volume) {
      largest_volume = volume;
      largest.swap(region);
    }
  }
  return largest;
}

}  // namespace

Extent measure_extent(const Particles& particles, const PackedLists& neighbours,
                      const std::vector<double>& level, bool connected) {
  Extent extent;
  std::vector<std::uint32_t> region;
  if (connected) {
    region = largest_region(particles, neighbours, level);
  } else {
    for (std::uint32_t i = 0; i < particles.size(); ++i) {
      if (level[i] >= 0) {
        region.push_back(i);
      }
    }
  }
  if (region.empty()) {
    return extent;
  }
  Vector low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  const auto include = [&](const Vector& p) {
    for (std::size_t d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], p[d]);
      high[d] = std::max(high[d], p[d]);
    }
  };
  for (const std::uint32_t i : region) {
    extent.volume += particles.volume[i];
    include(particles.position[i]);
    for_each_touching(particles, neighbours, i, [&](std::uint32_t j) {
      if (level[j] < 0) {
        const double share = level[i] / (level[i] - level[j]);
        Vector crossing{};
        for (std::size_t d = 0; d < 3; ++d) {
          crossing[d] = particles.position[i][d] +
                        share * (particles.position[j][d] - particles.position[i][d]);
        }
        include(crossing);
      }
    });
  }
  extent.found = true;
  extent.onset = high[0];
  extent.end = low[0];
  extent.length = high[0] - low[0];
  extent.width = high[1] - low[1];
  extent.depth = std::max(0.0, -low[2]);
  return extent;
}

}  // namespace meltproof::solver

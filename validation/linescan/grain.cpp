// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/linescan/grain.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace meltproof::validation {
namespace {

using Cell = std::array<long long, 3>;

/// Sets of connected additive particles, by index, each in order of identity.
std::vector<std::vector<std::size_t>> clusters(const SolidifiedTrack& track) {
  const double reach = 1.5 * track.spacing;
  std::vector<std::size_t> additive;
  for (std::size_t i = 0; i < track.origin.size(); ++i) {
    if (track.origin[i] == 2) {
      additive.push_back(i);
    }
  }
  std::sort(additive.begin(), additive.end(),
            [&](std::size_t a, std::size_t b) { return track.identity[a] < track.identity[b]; });
  const auto cell_of = [&](std::size_t i) {
    Cell cell{};
    for (std::size_t d = 0; d < 3; ++d) {
      cell[d] = static_cast<long long>(std::floor(track.first_position[i][d] / reach));
    }
    return cell;
  };
  std::map<Cell, std::vector<std::size_t>> cells;
  for (const std::size_t i : additive) {
    cells[cell_of(i)].push_back(i);
  }
  std::vector<bool> taken(track.origin.size(), false);
  std::vector<std::vector<std::size_t>> result;
  for (const std::size_t seed : additive) {
    if (taken[seed]) {
      continue;
    }
    taken[seed] = true;
    std::vector<std::size_t> members = {seed};
    for (std::size_t k = 0; k < members.size(); ++k) {
      const Cell at = cell_of(members[k]);
      const Point& a = track.first_position[members[k]];
      for (long long offset = 0; offset < 27; ++offset) {
        const auto cell = cells.find(
            {at[0] + offset % 3 - 1, at[1] + offset / 3 % 3 - 1, at[2] + offset / 9 - 1});
        if (cell == cells.end()) {
          continue;
        }
        for (const std::size_t other : cell->second) {
          const Point& b = track.first_position[other];
          if (!taken[other] && std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) <= reach) {
            taken[other] = true;
            members.push_back(other);
          }
        }
      }
    }
    result.push_back(std::move(members));
  }
  return result;
}

}  // namespace

double Grain::edge_distance() const {
  return std::min(centre[1] - edge_low, edge_high - centre[1]);
}

std::vector<Grain> find_grains(const SolidifiedTrack& track) {
  std::vector<Grain> grains;
  for (const auto& members : clusters(track)) {
    Grain grain;
    grain.particles = members.size();
    grain.first_identity = track.identity[members.front()];
    const auto count = static_cast<double>(members.size());
    for (const std::size_t i : members) {
      for (std::size_t d = 0; d < 3; ++d) {
        grain.centre[d] += track.position[i][d] / count;
      }
      grain.melted += (track.melted[i] != 0 ? 1 : 0) / count;
    }
    grain.edge_low = grain.edge_high = grain.centre[1];
    bool any = false;
    for (std::size_t i = 0; i < track.position.size(); ++i) {
      const Point& p = track.position[i];
      // The pool is where base metal melted: a grain of the additive melts 800 K earlier, also
      // alone in the loose powder.
      if (track.melted[i] != 0 && track.origin[i] != 2 &&
          std::abs(p[0] - grain.centre[0]) <= track.spacing) {
        grain.edge_low = any ? std::min(grain.edge_low, p[1]) : p[1];
        grain.edge_high = any ? std::max(grain.edge_high, p[1]) : p[1];
        any = true;
      }
    }
    grain.beside_pool = any;
    grains.push_back(grain);
  }
  return grains;
}

std::optional<Grain> grain_at_pool_edge(const SolidifiedTrack& track) {
  std::optional<Grain> best;
  for (const auto& grain : find_grains(track)) {
    const bool nearer = !best || std::abs(grain.edge_distance()) < std::abs(best->edge_distance());
    if (grain.melted >= 0.5 && grain.beside_pool && nearer) {
      best = grain;
    }
  }
  return best;
}

Point line_end(const Grain& grain, Direction direction, double length) {
  Point end = grain.centre;
  if (direction == Direction::depth) {
    end[2] -= length;
  } else {
    const double middle = 0.5 * (grain.edge_low + grain.edge_high);
    end[1] += grain.centre[1] > middle ? -length : length;
  }
  return end;
}

}  // namespace meltproof::validation

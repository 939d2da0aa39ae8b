// SPDX-License-Identifier: GPL-3.0-or-later
// The additive grain that the paper's Fig. 7 looks at: one that melted at the edge of the pool.
#pragma once

#include <optional>

#include "validation/linescan/solidified_track.hpp"

namespace meltproof::validation {

/// A grain of additive powder and where it came to rest.
struct Grain {
  Point centre{};             ///< m, mean of its particles in the last snapshot
  std::size_t particles = 0;  ///< particles that it is made of
  double melted = 0;          ///< share of them that were ever liquid
  bool beside_pool = false;   ///< whether base metal melted at its x
  double edge_low = 0;        ///< y of the edges of the molten base metal at the grain, m
  double edge_high = 0;
  std::int64_t first_identity = 0;  ///< smallest identity, which names the grain
  /// Distance of its centre from the nearer edge, m; negative outside the molten zone.
  double edge_distance() const;
};

/// All grains: sets of additive particles that are connected in the first snapshot (neighbours
/// within 1.5 spacings; grains in contact count as one), with the molten zone's edges: smallest and
/// largest y of all particles that were ever liquid within one spacing of the grain's x. In order
/// of identity.
std::vector<Grain> find_grains(const SolidifiedTrack& track);

/// The rule: of the grains of which at least half melted, the one whose centre is nearest to an
/// edge of the molten zone; of equals the one of the smallest identity. Nothing if no grain melted.
std::optional<Grain> grain_at_pool_edge(const SolidifiedTrack& track);

enum class Direction {
  depth,    ///< from the grain's centre down
  lateral,  ///< from the grain's centre across the scan, towards the middle of the molten zone
};

/// The far end of a line of `length` from the grain's centre.
Point line_end(const Grain& grain, Direction direction, double length);

}  // namespace meltproof::validation

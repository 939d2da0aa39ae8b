// SPDX-License-Identifier: GPL-3.0-or-later
// How the track froze, on a regular grid, as grain structure codes read it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "solver/particles/particles.hpp"

namespace meltproof::solver {

/// What the last snapshot of a run says about solidification, SI.
struct FrozenTrack {
  Particles particles;  ///< position, melt_time, freeze_time, cooling_rate, freeze_gradient, phase
  double time = 0;      ///< s, of the snapshot
  std::size_t frozen = 0, still_liquid = 0;  ///< particles
};

/// Reads the last snapshot. @throws InputError if the file is no run, or its snapshots are of a
/// version without times of melting and freezing.
FrozenTrack read_frozen_track(const std::filesystem::path& run);

/// Whether particle i melted and froze again, with a cooling rate and a gradient.
bool is_frozen(const Particles& particles, std::size_t i);

/// One place of the grid.
struct FrozenPoint {
  Vector at{};              ///< m, whole multiples of the cell
  double melt_time = 0;     ///< s, when the material that froze here melted last
  double freeze_time = 0;   ///< s, when it fell below its liquidus
  double cooling_rate = 0;  ///< K s-1, then
  double gradient = 0;      ///< K m-1, then
  double velocity() const { return cooling_rate / gradient; }  ///< m s-1, of the liquidus
};

/// Interpolates to every multiple of `cell` (m) that lies in frozen material: where the nearest
/// metal particle, at most 0.9 spacings away, has melted and frozen. The value is that of a linear
/// function fitted by weighted least squares to the frozen particles within 2 spacings (Wendland
/// C2 weights), kept between their least and largest value; the weighted mean where they are fewer
/// than 8 or lie in a plane. A linear field is reproduced exactly inside the frozen region.
/// Particles do not move once frozen, so places are those of freezing; the material melted
/// elsewhere. Points are in the order z, y, x, x fastest.
/// @throws InputError if the cell is not above zero or the grid would have over 2e8 places.
std::vector<FrozenPoint> interpolate(const FrozenTrack& track, double cell);

/// `x,y,z,tm,ts,cr` in m, s, s, K/s: a line per place, as AdditiveFOAM writes and ExaCA reads it.
std::string exaca_csv(const std::vector<FrozenPoint>& points);
/// `x,y,z,ts,cr,g,v` in m, s, K/s, K/m, m/s, with v = cr / g.
std::string gradient_csv(const std::vector<FrozenPoint>& points);

}  // namespace meltproof::solver

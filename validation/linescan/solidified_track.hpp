// SPDX-License-Identifier: GPL-3.0-or-later
// The concentration that a run leaves behind in the solidified track, and its value along a line.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace meltproof::validation {

using Point = std::array<double, 3>;  ///< m; x along the scan, y lateral, z up from the plate

/// The last snapshot of run.h5. One entry per particle.
struct SolidifiedTrack {
  double spacing = 0, smoothing_length = 0;  ///< m
  double time = 0;                           ///< s
  std::vector<Point> position;               ///< m
  std::vector<Point> first_position;         ///< m, of the same particle in the first snapshot
  std::vector<double> concentration;         ///< mass fraction of AlSi10Mg
  std::vector<std::int64_t> identity;
  std::vector<std::int32_t> origin;  ///< 0 plate, 1 base powder, 2 additive powder
  std::vector<std::uint8_t> melted;  ///< 1 if ever liquid
};

/// @throws InputError naming the file for: no artifact of kind "meltproof run", no snapshot, a
/// missing
///         data set, fields of different length.
SolidifiedTrack read_solidified_track(const std::filesystem::path& path);

/// The concentration between the particles of a region: sum_j V C_j W / sum_j V W (Shepard) with
/// the quintic spline of the run, over all material, melted or not.
class TrackField {
 public:
  /// @param low,high corners of the box in which it will be asked, in any order
  TrackField(const SolidifiedTrack& track, const Point& low, const Point& high);
  /// NaN where there is no material: where sum_j V W < 0.5, which is the value on a flat surface,
  /// and no particle's own sphere reaches.
  double at(const Point& point) const;

 private:
  const SolidifiedTrack& track_;
  std::vector<std::size_t> near_;  ///< the particles that reach into the box
};

/// Concentration along a straight line.
struct SimulatedProfile {
  Point start{}, end{};               ///< m
  std::vector<double> position;       ///< m from the start, evenly spaced
  std::vector<double> concentration;  ///< NaN where there is no material
};

/// TrackField::at() along a line.
/// @param step distance of the samples in m; it is rounded so that the line's end is one of them.
/// @throws InputError if the line is shorter than a step, or has no material anywhere.
SimulatedProfile sample_line(const SolidifiedTrack& track, const Point& start, const Point& end,
                             double step);

}  // namespace meltproof::validation

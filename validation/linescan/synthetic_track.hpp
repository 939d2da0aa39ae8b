// SPDX-License-Identifier: GPL-3.0-or-later
// A small synthetic run for the tests of the line scan: no simulation made it.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "base/artifact.hpp"
#include "validation/linescan/solidified_track.hpp"

namespace meltproof::validation {

/// A plate of 40 x 80 x 40 um in spacings of 2 um under z = 0 that melted for |y| <= 30 um, with
/// the concentration given by `concentration`, and additive particles where `additive` says so.
inline SolidifiedTrack synthetic_track(const std::function<double(const Point&)>& concentration,
                                       const std::function<bool(const Point&)>& additive) {
  SolidifiedTrack track;
  const double dx = 2e-6;
  track.spacing = track.smoothing_length = dx;
  track.time = 1e-3;
  for (int i = 0; i < 20; ++i) {
    for (int j = -20; j < 20; ++j) {
      for (int k = -20; k < 0; ++k) {
        const Point p{(i + 0.5) * dx, (j + 0.5) * dx, (k + 0.5) * dx};
        track.position.push_back(p);
        track.first_position.push_back(p);
        track.identity.push_back(static_cast<std::int64_t>(track.identity.size()));
        track.origin.push_back(additive(p) ? 2 : 0);
        track.melted.push_back(std::abs(p[1]) <= 30e-6 ? 1 : 0);
        track.concentration.push_back(concentration(p));
      }
    }
  }
  return track;
}

/// Writes it as run.h5 with two equal snapshots.
inline void write_synthetic_run(const SolidifiedTrack& track, const std::filesystem::path& path) {
  ArtifactWriter writer(path, "meltproof run");
  const std::string made = "synthetic, for a test";
  writer.write("spacing", track.spacing, "m", made);
  writer.write("smoothing_length", track.smoothing_length, "m", made);
  std::vector<double> position;
  for (const auto& p : track.position) {
    position.insert(position.end(), p.begin(), p.end());
  }
  const std::size_t n = track.position.size();
  for (const std::string group : {"snapshots/0000/", "snapshots/0001/"}) {
    writer.write(group + "time", track.time, "s", made);
    writer.write(group + "position", std::span<const double>(position), {n, 3}, "m", made);
    writer.write(group + "concentration", std::span<const double>(track.concentration), {n}, "1",
                 made);
    writer.write(group + "identity", std::span<const std::int64_t>(track.identity), {n}, "1", made);
    writer.write(group + "origin", std::span<const std::int32_t>(track.origin), {n}, "1", made);
    writer.write(group + "melted", std::span<const std::uint8_t>(track.melted), {n}, "1", made);
  }
  writer.commit({});
}

}  // namespace meltproof::validation

// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/linescan/solidified_track.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_map>

#include <fmt/format.h>

#include "base/artifact.hpp"
#include "base/error.hpp"

namespace meltproof::validation {
namespace {

std::vector<Point> points(const DataSet<double>& data) {
  std::vector<Point> result(data.values.size() / 3);
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = {data.values[3 * i], data.values[3 * i + 1], data.values[3 * i + 2]};
  }
  return result;
}

/// Fields that never change may stand beside the snapshots instead of in each of them.
std::string field(const ArtifactReader& run, const std::string& group, const std::string& name) {
  return run.has(group + name) || !run.has(name) ? group + name : name;
}

/// Quintic spline in three dimensions, support 3h (Morris 1996).
double kernel(double distance, double h) {
  const double q = distance / h;
  const auto fifth = [](double x) { return x > 0 ? x * x * x * x * x : 0.0; };
  return (fifth(3 - q) - 6 * fifth(2 - q) + 15 * fifth(1 - q)) /
         (120 * std::numbers::pi * h * h * h);
}

double distance(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

SolidifiedTrack read_solidified_track(const std::filesystem::path& path) {
  const ArtifactReader run(path, "meltproof run");
  const auto snapshots = run.has("snapshots") ? run.names("snapshots") : std::vector<std::string>{};
  if (snapshots.empty()) {
    throw InputError(fmt::format("{}: it holds no snapshot: the run did not get to its first one.",
                                 path.string()));
  }
  const auto [first, last] = std::minmax_element(snapshots.begin(), snapshots.end());
  const std::string begin = "snapshots/" + *first + "/", end = "snapshots/" + *last + "/";
  SolidifiedTrack track;
  track.spacing = run.scalar("spacing");
  track.smoothing_length = run.scalar("smoothing_length");
  track.time = run.scalar(end + "time");
  track.position = points(run.read<double>(end + "position"));
  track.concentration = run.read<double>(end + "concentration").values;
  track.identity = run.read<std::int64_t>(end + "identity").values;
  track.origin = run.read<std::int32_t>(field(run, end, "origin")).values;
  track.melted = run.read<std::uint8_t>(field(run, end, "melted")).values;
  const std::size_t n = track.position.size();
  if (track.concentration.size() != n || track.identity.size() != n || track.origin.size() != n ||
      track.melted.size() != n) {
    throw InputError(fmt::format(
        "{}: the fields of {} have different lengths ({} positions, {} concentrations).",
        path.string(), end, n, track.concentration.size()));
  }
  const auto start = points(run.read<double>(begin + "position"));
  const auto names = run.read<std::int64_t>(begin + "identity").values;
  std::unordered_map<std::int64_t, std::size_t> place;
  for (std::size_t i = 0; i < std::min(names.size(), start.size()); ++i) {
    place[names[i]] = i;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const auto at = place.find(track.identity[i]);
    track.first_position.push_back(at == place.end() ? track.position[i] : start[at->second]);
  }
  return track;
}

TrackField::TrackField(const SolidifiedTrack& track, const Point& low, const Point& high)
    : track_(track) {
  const double reach = 3 * track.smoothing_length;
  for (std::size_t i = 0; i < track.position.size(); ++i) {
    bool inside = true;
    for (std::size_t d = 0; d < 3; ++d) {
      const auto [least, most] = std::minmax(low[d], high[d]);
      inside =
          inside && track.position[i][d] > least - reach && track.position[i][d] < most + reach;
    }
    if (inside) {
      near_.push_back(i);
    }
  }
}

double TrackField::at(const Point& point) const {
  const double volume = std::pow(track_.spacing, 3);
  // Of the sphere as large as a particle: a grain of one particle fills less than half of its
  // kernel, and is metal all the same.
  const double particle_radius = std::cbrt(3 / (4 * std::numbers::pi)) * track_.spacing;
  double sum = 0, weight = 0;
  bool inside = false;
  const double reach = 3 * track_.smoothing_length;
  for (const std::size_t j : near_) {
    const Point& other = track_.position[j];
    const double dx = point[0] - other[0], dy = point[1] - other[1], dz = point[2] - other[2];
    const double squared = dx * dx + dy * dy + dz * dz;
    if (squared > reach * reach) {
      continue;  // most of the box, for each of thousands of samples
    }
    const double r = std::sqrt(squared);
    const double w = volume * kernel(r, track_.smoothing_length);
    inside = inside || r <= particle_radius;
    sum += w * track_.concentration[j];
    weight += w;
  }
  return inside || weight >= 0.5 ? sum / weight : std::numeric_limits<double>::quiet_NaN();
}

SimulatedProfile sample_line(const SolidifiedTrack& track, const Point& start, const Point& end,
                             double step) {
  const double length = distance(start, end);
  if (!(step > 0 && length >= step)) {
    throw InputError(fmt::format(
        "a line of {:.4g} um cannot be sampled every {:.4g} um: expected a longer line or a "
        "smaller, positive step.",
        1e6 * length, 1e6 * step));
  }
  const TrackField field(track, start, end);
  const auto intervals = static_cast<std::size_t>(std::lround(length / step));
  SimulatedProfile profile{start, end, {}, {}};
  bool found = false;
  for (std::size_t i = 0; i <= intervals; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(intervals);
    Point at{};
    for (std::size_t d = 0; d < 3; ++d) {
      at[d] = start[d] + part * (end[d] - start[d]);
    }
    const double concentration = field.at(at);
    found = found || !std::isnan(concentration);
    profile.position.push_back(part * length);
    profile.concentration.push_back(concentration);
  }
  if (!found) {
    throw InputError(fmt::format(
        "the line from ({:.4g}, {:.4g}, {:.4g}) um to ({:.4g}, {:.4g}, {:.4g}) um meets no "
        "material: x runs along the scan, y across it, z up from the plate's surface.",
        1e6 * start[0], 1e6 * start[1], 1e6 * start[2], 1e6 * end[0], 1e6 * end[1], 1e6 * end[2]));
  }
  return profile;
}

}  // namespace meltproof::validation

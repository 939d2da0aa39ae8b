// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/tracking.hpp"

#include <algorithm>
#include <cmath>

#include "imaging/meltpool/statistics.hpp"

namespace meltproof::imaging {
namespace {

constexpr std::size_t fewest = 8, most = 60, longest_gap = 3;

/// Fills in what the members of a passage have in common. @return whether there are enough.
bool describe(Passage& passage, std::span<const Sighting> sightings) {
  std::vector<std::size_t> whole;
  for (const std::size_t i : passage.members)
    if (sightings[i].whole) whole.push_back(i);
  if (whole.size() < fewest) return false;
  const std::size_t step = (whole.size() + most - 1) / most;
  std::vector<double> frame, onset, across, area;
  for (std::size_t i = 0; i < whole.size(); i += step) {
    const Sighting& s = sightings[whole[i]];
    frame.push_back(static_cast<double>(s.frame));
    onset.push_back(s.onset);
    across.push_back(s.across);
    area.push_back(s.area);
  }
  const RobustLine line = robust_line(frame, onset);
  passage.speed = line.slope;
  passage.onset = line.intercept;
  passage.tolerance = std::max(3.0, 5 * line.deviation);
  passage.across = median(across);
  passage.area = median(area);
  for (auto& a : area) a = std::abs(a - passage.area);
  passage.area_spread = 1.4826 * median(area);
  return true;
}

}  // namespace

std::vector<Passage> find_passages(std::span<const Sighting> sightings, double extent) {
  std::vector<Passage> passages;
  Passage current;
  const auto finish = [&] {
    if (describe(current, sightings)) passages.push_back(std::move(current));
    current = {};
  };
  double furthest =
      0;  // of the passage so far; spatter ahead must not set it, so it is the last two's lower
  double before = 0;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const Sighting& s = sightings[i];
    if (!current.members.empty()) {
      const bool gap = s.frame - sightings[current.members.back()].frame > longest_gap;
      if (gap || s.onset < furthest - 0.25 * extent) {
        // One frame of spatter does not end a passage: the next one must be behind as well.
        const bool also =
            i + 1 < sightings.size() && sightings[i + 1].onset < furthest - 0.25 * extent;
        if (gap || also) {
          finish();
          furthest = before = s.onset;
        }
      }
    } else {
      furthest = before = s.onset;
    }
    current.members.push_back(i);
    furthest = std::max(furthest, std::min(before, s.onset));
    before = s.onset;
  }
  finish();
  return passages;
}

Disturbance disturbance_of(const Sighting& s, const Passage& p) {
  // At the border the leading edge is the image's own.
  if (s.whole && std::abs(s.onset - p.expected_onset(s.frame)) > p.tolerance)
    return Disturbance::displaced;
  if (s.whole && std::abs(s.across - p.across) > 3) return Disturbance::displaced;
  const double allowed = std::max(0.25 * p.area, 5 * p.area_spread);
  if (s.whole && std::abs(s.area - p.area) > allowed) return Disturbance::enlarged;
  return Disturbance::none;
}

}  // namespace meltproof::imaging

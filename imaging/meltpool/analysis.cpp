// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/analysis.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/progress.hpp"

namespace meltproof::imaging {
namespace {

bool is_forward(ScanDirection direction) {
  return direction == ScanDirection::right || direction == ScanDirection::down;
}

/// Eight numbers side by side. A vector of the compiler's own (GCC and Clang), because GCC does not
/// find the lanes in a loop over arrays.
constexpr std::size_t lanes = 8;
using Floats [[gnu::vector_size(lanes * sizeof(float))]] = float;
using Doubles [[gnu::vector_size(lanes * sizeof(double))]] = double;

/// Lowest, highest and mean of the values that count. Sums run in eight lanes, whatever the
/// machine, so that they can be done at once and come out the same everywhere.
Range range_of(const std::vector<float>& values) {
  const std::size_t n = values.size();
  if (n == 0) return {NAN, NAN, NAN};
  Floats low = values[0] - Floats{}, high = low;
  Doubles sum{};
  const float* p = values.data();
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes, p += lanes) {
    Floats v;
    std::memcpy(&v, p, sizeof v);
    low = v < low ? v : low;
    high = high < v ? v : high;
    sum += __builtin_convertvector(v, Doubles);
  }
  for (std::size_t lane = 0; i < n; ++i, ++lane) {
    low[lane] = std::min<float>(low[lane], values[i]);
    high[lane] = std::max<float>(high[lane], values[i]);
    sum[lane] += static_cast<double>(values[i]);
  }
  float lowest = low[0], highest = high[0];
  double total = 0;
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    lowest = std::min<float>(lowest, low[lane]);
    highest = std::max<float>(highest, high[lane]);
    total += sum[lane];
  }
  return {static_cast<double>(lowest), static_cast<double>(highest),
          total / static_cast<double>(n)};
}

/// Counts the pixels that are not good into `result`. Nearly every frame has none of them, or few,
/// which the search for the next byte that is not zero sees many pixels at a time.
void count_marks(const std::vector<PixelStatus>& status, FrameResult& result) {
  static_assert(static_cast<int>(PixelStatus::good) == 0);
  std::uint8_t any = 0;
  for (const PixelStatus s : status) any |= static_cast<std::uint8_t>(s);
  if (any == 0) return;
  for (const PixelStatus s : status) {
    result.saturated += s == PixelStatus::saturated ? 1 : 0;
    result.under_range += s == PixelStatus::under_range ? 1 : 0;
    result.dead += s == PixelStatus::dead ? 1 : 0;
  }
}

FrameResult describe(const Frame& frame) {
  FrameResult result;
  result.index = frame.index;
  result.time = frame.time;
  count_marks(frame.status, result);
  if (result.dead == 0) {
    result.values = range_of(frame.values);
  } else {
    std::vector<float> alive;
    for (std::size_t i = 0; i < frame.values.size(); ++i)
      if (frame.status[i] != PixelStatus::dead) alive.push_back(frame.values[i]);
    result.values = range_of(alive);
  }
  if (!frame.counts.empty()) result.counts = range_of(frame.counts);
  return result;
}

/// The dimensions of a region in the scan's own terms.
void measure(FrameResult& result, Region region, ScanDirection direction, const PixelSize& pixel) {
  const double px = pixel.known() ? pixel.x : 1, py = pixel.known() ? pixel.y : 1;
  const bool along_x = direction == ScanDirection::right || direction == ScanDirection::left;
  // Positions are counted from the image's border, which lies half a pixel before the first centre.
  const Extent x{(region.x.low + 0.5) * px, (region.x.high + 0.5) * px};
  const Extent y{(region.y.low + 0.5) * py, (region.y.high + 0.5) * py};
  const Extent& along = along_x ? x : y;
  const bool forward = is_forward(direction);
  result.found = true;
  result.complete = !region.at_border();
  result.onset = forward ? along.high : along.low;
  result.end = forward ? along.low : along.high;
  result.length = along.size();
  result.depth = (along_x ? y : x).size();
  result.area = region.area * px * py;
  result.orientation =
      0.5 * std::atan2(2 * region.xy * px * py, region.xx * px * px - region.yy * py * py);
  result.region = std::move(region);
}

/// The pool of a frame at a level, with the front marked first where the level has a step.
struct Search {
  Search(const RecordingHeader& header, const Level& wanted, bool along_scan_x, Outline outline)
      : level(wanted),
        along_x(along_scan_x),
        width(header.width),
        height(header.height),
        finder(header.width, header.height, wanted.interpolation, outline) {}
  std::optional<Region> pool(const Frame& frame) {
    if (!level.step) return finder.largest(frame.values, *level.value);
    front_lines = mark_fronts(frame.values, width, height, along_x, *level.step, marked);
    return finder.largest(marked, *level.value);
  }
  /// The largest region near a place: where the largest of all does not move with the beam.
  std::optional<Region> pool_near(const Frame& frame, Point place, double distance) {
    if (!level.step) return finder.largest_near(frame.values, *level.value, place, distance);
    front_lines = mark_fronts(frame.values, width, height, along_x, *level.step, marked);
    return finder.largest_near(marked, *level.value, place, distance);
  }
  const Level& level;
  bool along_x;
  std::size_t width, height;
  RegionFinder finder;
  std::vector<float> marked;
  std::size_t front_lines = 0;
};

/// A frame's region as tracking sees it, with the scan towards higher numbers.
Sighting sighting_of(const FrameResult& f, ScanDirection direction) {
  const bool along_x = direction == ScanDirection::right || direction == ScanDirection::left;
  const Extent& along = along_x ? f.region.x : f.region.y;
  return {f.index, !f.region.at_border(), is_forward(direction) ? along.high : -along.low,
          along_x ? f.region.centroid.y : f.region.centroid.x, f.region.area};
}

/// Drops what does not move with the beam. In a frame whose largest region is elsewhere, the pool
/// is looked for where it should be.
void follow_pool(Analysis& analysis, const Recording& recording, ScanDirection direction,
                 const PixelSize& pixel, Search& search) {
  std::vector<Sighting> sightings;
  std::vector<std::size_t> frame_of;
  for (std::size_t i = 0; i < analysis.frames.size(); ++i) {
    if (!analysis.frames[i].found) continue;
    sightings.push_back(sighting_of(analysis.frames[i], direction));
    frame_of.push_back(i);
  }
  const auto& h = recording.header();
  const auto extent = static_cast<double>(analysis.along_x ? h.width : h.height);
  const auto passages = find_passages(sightings, extent);
  analysis.passages = passages.size();
  Frame frame;
  for (const Passage& passage : passages)
    for (const std::size_t member : passage.members) {
      FrameResult& result = analysis.frames[frame_of[member]];
      Sighting seen = sightings[member];
      result.disturbance = disturbance_of(seen, passage);
      if (result.disturbance == Disturbance::displaced) {
        recording.read(result.index, frame);
        // The pool's middle lies behind its leading edge by some part of its length.
        const double along =
            passage.expected_onset(result.index) - 0.5 * std::sqrt(std::max(passage.area, 1.0));
        const double signed_along = is_forward(direction) ? along : -along;
        const Point place = analysis.along_x ? Point{signed_along, passage.across}
                                             : Point{passage.across, signed_along};
        auto region = search.pool_near(frame, place, std::sqrt(passage.area) + passage.tolerance);
        if (region && region->pixels >= smallest_pool) {
          FrameResult other = result;
          measure(other, std::move(*region), direction, pixel);
          other.front_lines = search.front_lines;
          other.complete = other.complete && !(analysis.level.step && other.front_lines == 0);
          const Sighting there = sighting_of(other, direction);
          if (disturbance_of(there, passage) == Disturbance::none) {
            result = std::move(other);
            result.disturbance = Disturbance::none;
            seen = there;
            ++analysis.replaced;
          }
        }
      }
      if (seen.whole) result.speed_check = seen.onset - passage.expected_onset(result.index);
      result.complete = result.complete && result.disturbance == Disturbance::none;
    }
}

void summarise_frames(Analysis& analysis, ScanDirection direction) {
  const auto complete = std::count_if(analysis.frames.begin(), analysis.frames.end(),
                                      [](const FrameResult& f) { return f.complete; });
  analysis.only_incomplete = complete == 0;
  std::vector<double> length, depth, area, time, onset;
  for (const auto& f : analysis.frames) {
    if (!(analysis.only_incomplete ? f.found : f.complete)) continue;
    length.push_back(f.length);
    depth.push_back(f.depth);
    area.push_back(f.area);
    time.push_back(f.time);
    onset.push_back(f.onset);
  }
  analysis.length = summarise(length);
  analysis.depth = summarise(depth);
  analysis.area = summarise(area);
  if (time.size() >= 3 && time.back() > time.front())
    analysis.speed = (is_forward(direction) ? 1 : -1) * slope(time, onset);

  // The frame that is shown is the one most like the mean; without a pool, the brightest.
  const auto merit = [&](const FrameResult& f) {
    if (!analysis.found) return f.values.high;
    const bool counted = analysis.only_incomplete ? f.found : f.complete;
    return counted ? -std::abs(f.length - analysis.length.mean) : -1e300;
  };
  const auto best =
      std::max_element(analysis.frames.begin(), analysis.frames.end(),
                       [&](const auto& a, const auto& b) { return merit(a) < merit(b); });
  analysis.shown = best->index;
}

}  // namespace

ScanDirection parse_scan_direction(const std::string& text) {
  if (text == "+x") return ScanDirection::right;
  if (text == "-x") return ScanDirection::left;
  if (text == "+y") return ScanDirection::down;
  if (text == "-y") return ScanDirection::up;
  throw InputError(fmt::format(
      "The scan direction is \"{}\"; expected +x, -x, +y or -y, with y downwards.", text));
}

std::optional<Region> pool_in(const Recording& recording, const Analysis& analysis,
                              const Frame& frame) {
  if (!analysis.level.value) return std::nullopt;
  Search search(recording.header(), analysis.level, analysis.along_x, Outline::edge);
  auto region = search.pool(frame);
  if (!region || region->pixels < smallest_pool) return std::nullopt;
  return region;
}

Analysis analyse(const Recording& recording, const LevelRequest& request, ScanDirection direction,
                 const PixelSize& pixel) {
  return analyse_at(recording, find_level(recording, request), direction, pixel);
}

Analysis analyse_at(const Recording& recording, const Level& level, ScanDirection direction,
                    const PixelSize& pixel) {
  const auto& header = recording.header();
  Analysis analysis;
  analysis.level = level;
  analysis.unit = pixel.known() ? std::string("m") : std::string("px");
  analysis.along_x = direction == ScanDirection::right || direction == ScanDirection::left;
  Search search(header, analysis.level, analysis.along_x, Outline::dimensions);
  Frame frame;
  std::size_t brightest = 0, largest = 0;
  Progress progress("extract", static_cast<double>(header.frames));
  analysis.frames.reserve(header.frames);
  for (std::size_t i = 0; i < header.frames; ++i) {
    recording.read(i, frame);
    auto result = describe(frame);
    if (analysis.level.value && result.values.high >= *analysis.level.value) {
      auto region = search.pool(frame);
      result.front_lines = search.front_lines;
      if (region) largest = std::max(largest, region->pixels);
      if (region && region->pixels >= smallest_pool) {
        measure(result, std::move(*region), direction, pixel);
        result.complete = result.complete && !(analysis.level.step && result.front_lines == 0);
      }
    }
    analysis.found = analysis.found || result.found;
    analysis.frames.push_back(std::move(result));
    if (analysis.frames.back().values.high > analysis.frames[brightest].values.high) brightest = i;
    progress.update(static_cast<double>(i + 1));
  }
  if (!analysis.found) {
    const auto& top = analysis.frames[brightest];
    if (!analysis.level.value)
      analysis.reason = analysis.level.reason;
    else if (largest > 0)
      analysis.reason = fmt::format(
          "The largest region at or above the level of {:.6g} {} has {} pixel{}, where a melt pool "
          "needs at least {}.",
          *analysis.level.value, header.unit, largest, largest == 1 ? "" : "s", smallest_pool);
    else
      analysis.reason = below_level_reason(header, analysis.level, top.values.high, top.index);
  }
  if (analysis.found) follow_pool(analysis, recording, direction, pixel, search);
  summarise_frames(analysis, direction);
  return analysis;
}

}  // namespace meltproof::imaging

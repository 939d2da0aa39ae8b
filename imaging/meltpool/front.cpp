// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/front.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace meltproof::imaging {
namespace {

/// One line of the image, counted outwards from its brightest pixel: at(0) is that pixel.
struct Line {
  const float* values;
  std::ptrdiff_t first, step, count;
  double dark;
  double at(std::ptrdiff_t i) const { return static_cast<double>(values[first + i * step]) - dark; }
};

constexpr std::ptrdiff_t apart =
    2;  // px: beyond the point spread, so what the slope is without the step

/// `logs` is memory that is used again.
std::optional<double> find_front(const Line& line, const EmissivityStep& step,
                                 std::vector<double>& logs) {
  const double liquid = step.liquid - step.dark, solid = step.solid - step.dark;
  // Wide enough for emissivities that are known to some 20 %.
  const double lowest = 0.8 * liquid, highest = 1.2 * solid;
  std::ptrdiff_t begin = apart + 1;
  while (begin + apart + 2 < line.count && line.at(begin + 1) > highest && line.at(begin) >= lowest)
    ++begin;
  std::ptrdiff_t end = begin;
  while (end + apart + 2 < line.count && line.at(end) >= lowest) ++end;
  if (begin == end) return std::nullopt;
  // ln S where it is needed: logarithms are most of the work.
  const std::ptrdiff_t first = begin - apart - 1, last = std::min(end + apart + 1, line.count - 1);
  const double floor = 1e-3 * line.at(0);
  logs.clear();
  for (std::ptrdiff_t i = first; i <= last; ++i)
    logs.push_back(std::log(std::max(line.at(i), floor)));
  /// The change of ln S from one pixel to the next one outwards: negative where the signal falls.
  const auto change = [&](std::ptrdiff_t i) {
    return logs[static_cast<std::size_t>(i + 1 - first)] -
           logs[static_cast<std::size_t>(i - first)];
  };
  double best = 0.25 * std::log(solid / liquid);
  std::optional<double> front;
  const auto above = [&](std::ptrdiff_t i) {
    return change(i) - 0.5 * (change(i - apart) + change(i + apart));
  };
  for (std::ptrdiff_t i = begin; i < end; ++i) {
    if (line.at(i + 1) > highest) continue;
    const double before = change(i - 1), at = change(i), after = change(i + 1);
    if (at < before || at < after) continue;
    // Two slopes together, because the step may fall on a pixel or between two.
    const double excess = above(i) + std::max(above(i - 1), above(i + 1));
    if (excess < best) continue;
    best = excess;
    const double curvature = before - 2 * at + after;
    const double offset =
        curvature < 0 ? std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5) : 0;
    front = static_cast<double>(i) + 0.5 + offset;
  }
  return front;
}

}  // namespace

double EmissivityStep::level() const { return dark + std::sqrt((liquid - dark) * (solid - dark)); }

std::size_t mark_fronts(std::span<const float> values, std::size_t width, std::size_t height,
                        bool along_x, const EmissivityStep& step, std::vector<float>& marked) {
  marked.assign(values.begin(), values.end());
  const auto w = static_cast<std::ptrdiff_t>(width), h = static_cast<std::ptrdiff_t>(height);
  const std::ptrdiff_t lines = along_x ? h : w, length = along_x ? w : h, stride = along_x ? 1 : w;
  const double level = step.level() - step.dark;
  // A pixel on the liquid side is at least this bright in the copy: anything above the level will
  // do.
  const double inside = 1.5 * level;
  // Rounded down, so that no line is passed over.
  const auto liquid = std::nextafter(static_cast<float>(step.liquid), 0.0F);
  std::vector<double> logs;
  std::size_t found = 0;
  for (std::ptrdiff_t k = 0; k < lines; ++k) {
    const std::ptrdiff_t start = along_x ? k * w : k;
    const float* const first = values.data() + start;
    // Most lines are dark, which a loop without branches sees at once.
    std::int32_t bright = 0;
    for (std::ptrdiff_t i = 0; i < length; ++i) bright |= first[i * stride] >= liquid ? 1 : 0;
    if (bright == 0) continue;
    std::ptrdiff_t peak = 0;
    for (std::ptrdiff_t i = 1; i < length; ++i)
      if (first[i * stride] > first[peak * stride]) peak = i;
    if (!(static_cast<double>(first[peak * stride]) >= step.liquid)) continue;
    bool any = false;
    for (const std::ptrdiff_t way : {std::ptrdiff_t{-1}, std::ptrdiff_t{1}}) {
      const Line line{values.data(), start + peak * stride, way * stride,
                      way < 0 ? peak + 1 : length - peak, step.dark};
      const auto front = find_front(line, step, logs);
      if (!front) continue;
      any = true;
      const auto last = static_cast<std::ptrdiff_t>(std::floor(*front));
      const auto put = [&](std::ptrdiff_t i, double signal) {
        marked[static_cast<std::size_t>(line.first + i * line.step)] =
            static_cast<float>(signal + step.dark);
      };
      for (std::ptrdiff_t i = 0; i < line.count; ++i) {
        if (i < last) put(i, std::max(line.at(i), inside));
        if (i == last) put(i, inside);
        // Between the last pixel inside and the first one outside, ln S falls linearly through the
        // level at the front. The latter stays above the floor that interpolation puts under noise.
        if (i == last + 1) {
          const double t = std::max(*front - static_cast<double>(last), 0.1);
          put(i, level * std::exp(std::log(inside / level) * (1 - 1 / t)));
        }
        if (i > last + 1) put(i, 0);
      }
    }
    found += any ? 1 : 0;
  }
  return found;
}

}  // namespace meltproof::imaging

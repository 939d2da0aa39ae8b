// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/contour.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace meltproof::imaging {

RegionFinder::RegionFinder(std::size_t width, std::size_t height, Interpolation interpolation,
                           Outline outline)
    : width_(static_cast<std::ptrdiff_t>(width)),
      height_(static_cast<std::ptrdiff_t>(height)),
      interpolation_(interpolation),
      outline_(outline),
      marks_(width * height) {}

/// Marks the pixels at or above the level. @return whether all values are numbers.
bool RegionFinder::mark(std::span<const float> values, float level) {
  // A loop without branches that the compiler does for many pixels at once; pointers of its own,
  // because a byte that is written could be any of this object's.
  const float* const v = values.data();
  std::uint8_t* const marks = marks_.data();
  const std::size_t n = values.size();
  std::uint8_t strange = 0;
  for (std::size_t i = 0; i < n; ++i) {
    marks[i] = v[i] >= level ? 1 : 0;
    strange |= v[i] != v[i] ? std::uint8_t{1} : std::uint8_t{0};
  }
  return strange == 0;
}

void RegionFinder::mend(std::span<const float> values, float level) {
  mended_.assign(values.begin(), values.end());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isnan(values[i])) continue;
    const auto x = static_cast<std::ptrdiff_t>(i) % width_,
               y = static_cast<std::ptrdiff_t>(i) / width_;
    float sum = 0;
    int above = 0;
    for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      if (x + dx < 0 || x + dx >= width_ || y + dy < 0 || y + dy >= height_) continue;
      const float v = values[static_cast<std::size_t>((y + dy) * width_ + x + dx)];
      if (v >= level) {
        sum += v;
        ++above;
      }
    }
    mended_[i] =
        above >= 3 ? sum / static_cast<float>(above) : -std::numeric_limits<float>::infinity();
  }
}

std::optional<Region> RegionFinder::largest(std::span<const float> values, double level) {
  return find(values, level, std::nullopt);
}

std::optional<Region> RegionFinder::largest_near(std::span<const float> values, double level,
                                                 Point place, double distance) {
  return find(values, level, Near{place, distance});
}

std::optional<Region> RegionFinder::find(std::span<const float> values, double level,
                                         const std::optional<Near>& near) {
  LevelImage image{values, width_, height_, static_cast<float>(level), interpolation_};
  if (!mark(values, image.level)) {
    mend(values, image.level);
    image.values = mended_;
    mark(image.values, image.level);
  }
  const auto runs = runs_.largest(
      marks_, static_cast<std::size_t>(width_),
      [&image](std::size_t x, std::size_t y) { return image.joined(x, y); }, near);
  if (runs.empty()) return std::nullopt;
  return walker_.walk(image, runs, outline_ == Outline::edge);
}

}  // namespace meltproof::imaging

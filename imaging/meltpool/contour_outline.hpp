// SPDX-License-Identifier: GPL-3.0-or-later
// The sub-pixel edge of one region and what it encloses.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "imaging/meltpool/contour_region.hpp"
#include "imaging/meltpool/contour_runs.hpp"

namespace meltproof::imaging {

/// An image and a level in it.
struct LevelImage {
  std::span<const float> values;  ///< width * height, row-major
  std::ptrdiff_t width = 0, height = 0;
  float level = 0;
  Interpolation interpolation;
  /// ln of the level above dark.
  double log_level() const;
  /// ln of a value above dark. Noise takes an outer pixel to or below dark; a thousandth of the
  /// level keeps its logarithm finite.
  double log_above_dark(float value, bool inside) const;
  /// Whether the mean of the square with upper left corner (x, y) is above the level.
  bool joined(std::size_t x, std::size_t y) const;
};

/// Walks the squares of the grid that a region's edge passes through; keeps its memory.
class OutlineWalker {
 public:
  /// @param runs the region, from the first row to the last; not empty.
  /// @param with_edge whether Region::edge is wanted.
  Region walk(const LevelImage& image, std::span<const Run> runs, bool with_edge);

 private:
  Point crossing(std::ptrdiff_t ax, std::ptrdiff_t ay, std::ptrdiff_t bx, std::ptrdiff_t by);
  float value(std::ptrdiff_t x, std::ptrdiff_t y) const;
  double logarithm(std::ptrdiff_t x, std::ptrdiff_t y, bool inside);
  std::size_t at(std::ptrdiff_t x, std::ptrdiff_t y) const {
    return static_cast<std::size_t>((y - y0_) * window_ + x - x0_);
  }

  LevelImage image_;
  double log_level_ = 0;
  std::ptrdiff_t x0_ = 0, y0_ = 0, window_ = 0;  ///< corner and width of the region's window
  std::vector<std::uint8_t> inside_;             ///< of the window: 1 in the region
  std::vector<double> logs_;                     ///< of the window; NaN: not computed yet
  std::vector<Point> below_;  ///< of each column, the crossing that the next row finds above it
  std::vector<double> right_, left_, down_, up_;  ///< outermost crossings of each row, column
};

}  // namespace meltproof::imaging

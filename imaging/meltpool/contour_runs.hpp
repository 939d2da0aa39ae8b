// SPDX-License-Identifier: GPL-3.0-or-later
// The connected regions of a frame above a level, as runs of pixels in rows.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "imaging/meltpool/contour_region.hpp"

namespace meltproof::imaging {

/// Pixels beside each other in one row: columns `begin` to `end` - 1.
struct Run {
  std::ptrdiff_t row = 0, begin = 0, end = 0;
};

/// A place that a region must be near: its pixels have their mean within `distance` px of it.
struct Near {
  Point place;
  double distance = 0;
};

/// Finds the largest region among marked pixels; keeps its memory between frames.
///
/// Runs of a row and of the row above belong together where they share a column (labelling by runs,
/// Rosenfeld and Pfaltz 1966, with a forest of sets, Galler and Fischer 1964), so that dark pixels,
/// nearly all of a frame, are only looked at by the search for the next bright one.
class RunFinder {
 public:
  /// Whether the two marked pixels of the square with upper left corner (x, y), which touch at a
  /// corner only, belong together.
  using Joined = std::function<bool(std::size_t x, std::size_t y)>;
  /// The region with most pixels; among equals the one whose first pixel comes first in the rows.
  /// @param marks width * height, row-major: 1 in a region, 0 outside.
  /// @param near if given, other regions do not count.
  /// @return its runs from the first row to the last, valid until the next call; empty if there is
  ///         none.
  std::span<const Run> largest(std::span<const std::uint8_t> marks, std::size_t width,
                               const Joined& joined, const std::optional<Near>& near);

 private:
  struct Total {
    std::size_t pixels = 0;
    double x = 0, y = 0;  ///< sums over the pixels
  };
  std::size_t root(std::size_t run);
  void unite(std::size_t a, std::size_t b);
  void join_row(std::size_t above, std::size_t begin, const Joined& joined);

  std::vector<Run> runs_;
  std::vector<std::size_t> parent_;  ///< of each run; a region's first run is its own parent
  std::vector<Total> totals_;        ///< of each region, at its first run
};

}  // namespace meltproof::imaging

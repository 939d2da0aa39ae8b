// SPDX-License-Identifier: GPL-3.0-or-later
// The region of a frame above a signal level, with a sub-pixel edge.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "imaging/meltpool/contour_outline.hpp"
#include "imaging/meltpool/contour_region.hpp"
#include "imaging/meltpool/contour_runs.hpp"

namespace meltproof::imaging {

/// What is wanted of a region.
enum class Outline {
  edge,       ///< all of it, with Region::edge
  dimensions  ///< without the edge, which a long recording would hold too often
};

/// Finds regions in frames of one size; keeps its memory between frames.
///
/// The edge is the contour of marching squares on the grid of pixel centres (Lorensen and Cline
/// 1987 in two dimensions); where a square is ambiguous its mean decides (Nielson and Hamann 1991),
/// and pixels that touch only at a corner belong together exactly if that contour joins them. Ends
/// are refined by a parabola through the crossings of three neighbouring rows, because the tip of a
/// pool hardly ever lies on a row. A region at the image's border ends at the outer edge of its
/// pixels.
class RegionFinder {
 public:
  RegionFinder(std::size_t width, std::size_t height, Interpolation interpolation,
               Outline outline = Outline::edge);
  /// The region with most pixels at or above `level`, or nothing if there is none.
  /// @param values width * height, row-major; a value that is no number counts as below the level,
  ///        unless at least three of its four neighbours are above, whose mean it then takes.
  std::optional<Region> largest(std::span<const float> values, double level);
  /// The same among regions whose pixels have their mean place within `distance` px of `place`.
  std::optional<Region> largest_near(std::span<const float> values, double level, Point place,
                                     double distance);

 private:
  std::optional<Region> find(std::span<const float> values, double level,
                             const std::optional<Near>& near);
  bool mark(std::span<const float> values, float level);
  void mend(std::span<const float> values, float level);

  std::ptrdiff_t width_, height_;
  Interpolation interpolation_;
  Outline outline_;
  std::vector<float> mended_;
  std::vector<std::uint8_t> marks_;  ///< 1 at or above the level
  RunFinder runs_;
  OutlineWalker walker_;
};

}  // namespace meltproof::imaging

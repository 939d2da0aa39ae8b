// SPDX-License-Identifier: GPL-3.0-or-later
// The region of a frame above a signal level, with a sub-pixel edge.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace meltproof::imaging {

/// A point of the image: x to the right, y downwards, in pixels; (0, 0) is the *centre* of the
/// upper left pixel, so the image spans -0.5 to width - 0.5.
struct Point {
  double x = 0, y = 0;
};

/// A piece of an edge, directed so that the region lies on its left when y is drawn upwards.
struct Segment {
  Point from, to;
};

/// Lower and upper end of a region along one axis, px.
struct Extent {
  double low = 0, high = 0;
  double size() const { return high - low; }
};

/// A connected region above the level.
struct Region {
  Extent x, y;                    ///< px, to a fraction of a pixel
  double area = 0;                ///< px^2
  Point centroid;                 ///< px
  double xx = 0, xy = 0, yy = 0;  ///< second central moments of the area, px^2
  std::size_t pixels = 0;         ///< pixels at or above the level
  bool left = false, right = false, top = false,
       bottom = false;        ///< borders of the image it touches
  std::vector<Segment> edge;  ///< in no particular order; they close up
  bool at_border() const { return left || right || top || bottom; }
  /// Area of the region over that of the ellipse with the same second moments: 1 for an ellipse,
  /// little for anything ragged, branched or hollow.
  double compactness() const;
};

/// How a value between two pixels is interpolated.
struct Interpolation {
  /// With a floor, the logarithm of (value - dark) is interpolated linearly, since emission falls
  /// exponentially from the pool outwards; it needs the signal without light. Without, the value
  /// is.
  bool logarithmic = false;
  double dark = 0;
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
  RegionFinder(std::size_t width, std::size_t height, Interpolation interpolation);
  /// The region with most pixels at or above `level`, or nothing if there is none.
  /// @param values width * height, row-major; a value that is no number counts as below the level,
  ///        unless at least three of its four neighbours are above, whose mean it then takes.
  std::optional<Region> largest(std::span<const float> values, double level);
  /// The same among regions whose pixels have their mean place within `distance` px of `place`.
  std::optional<Region> largest_near(std::span<const float> values, double level, Point place,
                                     double distance);

 private:
  void mend(std::span<const float> values, float level);
  bool joined(std::size_t x, std::size_t y, float level) const;
  void flood(std::size_t seed, std::int32_t label, float level);
  double crossing(float inside, float outside, double level) const;
  std::optional<Region> find(std::span<const float> values, double level, const Point* place,
                             double distance);
  Region outline(std::int32_t label, float level);

  std::ptrdiff_t width_, height_;
  Interpolation interpolation_;
  std::span<const float> values_;
  double log_level_ = 0;
  std::vector<float> mended_;
  std::vector<std::int32_t> labels_;
  std::vector<std::size_t> pixels_, stack_, largest_;
};

}  // namespace meltproof::imaging

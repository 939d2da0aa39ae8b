// SPDX-License-Identifier: GPL-3.0-or-later
// A region of an image and its edge, in pixels.
#pragma once

#include <cstddef>
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
       bottom = false;  ///< borders of the image it touches
  /// In no particular order; they close up. Empty where only the dimensions were asked for.
  std::vector<Segment> edge;
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

}  // namespace meltproof::imaging

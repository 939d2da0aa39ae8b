// SPDX-License-Identifier: GPL-3.0-or-later
// From a recording to the melt pool of every frame and the dimensions of the recording.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "imaging/meltpool/contour.hpp"
#include "imaging/meltpool/level.hpp"
#include "imaging/meltpool/statistics.hpp"
#include "imaging/meltpool/tracking.hpp"
#include "imaging/recording/recording.hpp"

namespace meltproof::imaging {

/// Where the beam goes in the image.
enum class ScanDirection { right, left, down, up };
/// "+x", "-x", "+y", "-y" with y downwards. @throws InputError otherwise.
ScanDirection parse_scan_direction(const std::string& text);

/// Size of a pixel on the object, m, with standard uncertainties. 0: unknown.
struct PixelSize {
  double x = 0, y = 0, u_x = 0, u_y = 0;
  bool known() const { return x > 0 && y > 0; }
};

/// Lowest, highest and mean of the pixels of a frame that are not dead.
struct Range {
  double low = 0, high = 0, mean = 0;
};

/// What one frame shows. Lengths in `unit` of the analysis: m, or px where no pixel size is known.
struct FrameResult {
  std::size_t index = 0;
  double time = 0;              ///< s
  Range values;                 ///< in the recording's unit
  std::optional<Range> counts;  ///< where the values were computed from counts
  std::size_t saturated = 0, under_range = 0, dead = 0;  ///< pixels
  bool found = false;
  bool complete = false;  ///< found whole: not at the image's border, and with its front if the
                          ///< level has a step
  double onset = 0,
         end = 0;  ///< leading edge and tail along the scan axis, from the left or upper border
  double length = 0, depth = 0;                 ///< along and across the scan axis
  double area = 0;                              ///< unit squared
  double orientation = 0;                       ///< rad, long axis from x towards y (downwards)
  Disturbance disturbance = Disturbance::none;  ///< what sets the region apart from the moving pool
  std::optional<double> speed_check;  ///< px, leading edge minus its passage's straight line
  std::size_t front_lines = 0;        ///< lines of pixels in which the front itself was seen
  Region region;                      ///< px, without its edge
};

/// The result of a recording.
struct Analysis {
  Level level;
  bool found = false;
  std::string reason;  ///< if not found, one sentence
  std::string unit;    ///< "m" or "px"
  bool along_x = true;
  std::vector<FrameResult> frames;
  /// Over the frames whose pool is complete, or over all with a pool if there is no complete one.
  bool only_incomplete = false;
  Series length, depth, area;
  std::optional<double>
      speed;  ///< m/s or px/s of the leading edge in the scan direction, least squares
  std::size_t passages = 0;  ///< of a pool through the image
  std::size_t replaced = 0;  ///< frames in which another region than the largest is the pool
  std::size_t shown = 0;     ///< the frame that tells most
};

/// Finds the level, then the pool in each frame.
Analysis analyse(const Recording& recording, const LevelRequest& request, ScanDirection direction,
                 const PixelSize& pixel);

/// The pool in each frame at a level that is known.
Analysis analyse_at(const Recording& recording, const Level& level, ScanDirection direction,
                    const PixelSize& pixel);

/// The pool of one frame with its edge, for drawing; nothing if the frame has none.
std::optional<Region> pool_in(const Recording& recording, const Analysis& analysis,
                              const Frame& frame);

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// The mean melt pool in its own moving frame: every frame of a recording, registered and averaged.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "imaging/meltpool/analysis.hpp"

namespace meltproof::imaging {

/// The mean pool, turned so that the scan runs along its lines towards higher columns. The pool
/// moves by a fraction of a pixel from frame to frame, so its frames sample it more finely than one
/// frame does; `samples` columns stand for one pixel. Positions along a line are pixels from the
/// middle of its first column.
struct Stack {
  static constexpr std::size_t samples = 4;  ///< columns a pixel
  std::size_t lines = 0;                     ///< across the scan
  std::size_t columns = 0;                   ///< along the scan, `samples` times whole pixels
  std::vector<float> signal;      ///< lines * columns, the recording's unit; NaN: never seen
  std::vector<float> deviation;   ///< the same, standard error of `signal`
  double onset = 0;               ///< px, where the leading edge was put
  double speed = 0;               ///< px a frame
  double residual = 0;            ///< px, standard deviation of the leading edge from its line
  std::size_t frames = 0;         ///< that were averaged
  std::vector<std::size_t> used;  ///< their numbers
  double noise = 0;               ///< standard deviation of a pixel where the pool's edge is
};

/// A stack, or the sentence why there is none.
struct StackResult {
  std::optional<Stack> stack;
  std::string reason;
};

/// Registers the frames of `analysis` whose pool is complete by a straight line through their
/// leading edges (Theil 1950, Sen 1968) and averages them, up to 400 of them. A sample is the mean
/// of its values without those beyond three robust standard deviations of their median, so that
/// what does not move with the pool (spatter, plume) falls out.
///
/// There is none, and a reason, where fewer than 12 frames show the whole pool, where the leading
/// edge leaves its line by more than half a pixel, or where the pool moves less than 0.05 px or
/// more than half its own length a frame.
StackResult stack_frames(const Recording& recording, const Analysis& analysis,
                         ScanDirection direction);

/// Dimensions of the mean pool, px.
struct StackedPool {
  double onset = 0, end = 0;  ///< along a line
  double length = 0, depth = 0;
};

/// Measures the mean pool at a level: by its contour on the stack's own columns; where the level
/// has a step, as frames are measured, in `samples` images of whole pixels, each at another offset,
/// whose results are averaged.
/// @param along,across px, sigma of a Gaussian with which the stack is smoothed before.
std::optional<StackedPool> measure_stack(const Stack& stack, const Level& level, double along = 0,
                                         double across = 0);

/// The signal of a stack, gaps along each line closed, after smoothing by a Gaussian.
std::vector<float> smoothed(const Stack& stack, double along, double across);

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// What pixels of uneven gain do to the dimensions of a pool.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <gsl/gsl_rng.h>

#include "imaging/meltpool/analysis.hpp"

namespace meltproof::imaging {

/// A draw's effect on mean length and depth, in the analysis' unit (m or px).
struct Effect {
  double length = 0, depth = 0;
};

/// Measures up to 48 frames of a recording, evenly chosen, again with other gains of their pixels.
class UnevenPixels {
 public:
  /// @param sigma standard deviation between the gains, 1. The analysis must outlive this.
  UnevenPixels(const Recording& recording, const Analysis& analysis, const PixelSize& pixel,
               double sigma);
  /// Draws a gain for every pixel, the same in all frames, and compares with even gains.
  Effect operator()(gsl_rng* random);
  /// Mean length and depth, in the analysis' unit, with all gains alike: at a level of the signal
  /// above dark that is `gain` times less. Frames whose region reaches the border are left out; a
  /// frame without a region counts as none. @return nothing where no frame is left.
  std::optional<Effect> with_gain(double gain);

 private:
  struct Mean {
    Effect size;
    double regions = 0;         ///< that the mean is over
    std::size_t at_border = 0;  ///< left out
  };
  Mean measure(bool whole);

  const Analysis& analysis_;
  double sigma_, dark_, along_ = 1, across_ = 1;
  std::size_t width_ = 0, height_ = 0;
  std::vector<Frame> frames_;
  std::vector<float> gain_, values_, marked_;
  Effect even_;
};

}  // namespace meltproof::imaging

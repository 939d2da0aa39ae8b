// SPDX-License-Identifier: GPL-3.0-or-later
// How the dimensions scatter from frame to frame, and how much of that is the pool's own.
#pragma once

#include <cstdint>

#include <gsl/gsl_rng.h>

#include "imaging/meltpool/stack.hpp"
#include "imaging/meltpool/uneven_pixels.hpp"

namespace meltproof::imaging {

/// A draw of the scatter of a series' mean: a scaled t distribution (JCGM 101, 6.4.9) with as many
/// degrees of freedom as independent values, less one.
double draw_mean(gsl_rng* random, const Series& series);

/// Mean over a part of the frames used, 0 <= from < to <= 1 of them: the choice of what counts as
/// steady.
Effect windowed(const Analysis& analysis, double from, double to);

/// The part of the frames' standard deviation that is the pool's own, 1.
struct OwnShare {
  double length = 1, depth = 1;
};

/// The mean pool does not scatter as single frames do: their noise is averaged in it, and what is
/// left of that stands in its fit. What noise and sampling alone make of a frame's dimensions is
/// found on 64 images of the mean pool with the noise of single frames, each at another place of
/// the grid; that variance is taken off the frames' own, as between components of a variance, and
/// what is left is none where it would be negative.
/// @param noise_factor by what the noise is larger than Stack::noise, a clipped mean's.
/// @param along,across size of a pixel in the analysis' unit.
OwnShare own_share(const Stack& stack, const Analysis& analysis, double noise_factor, double along,
                   double across, std::uint64_t seed);

}  // namespace meltproof::imaging

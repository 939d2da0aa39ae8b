// SPDX-License-Identifier: GPL-3.0-or-later
// The border of the plate in a side view, where a blurred pool ends for another reason than cold.
#pragma once

#include "imaging/meltpool/tail_model.hpp"

namespace meltproof::imaging {

/// Looks for a border of the metal across the scan: in every column of the mean pool the signal
/// above dark is modelled as (a + b d + c d^2) Phi(d / sigma), d the depth below the border and
/// sigma the blur. It is present where the columns agree within 0.35 px and the signal at the
/// border is at least 0.7 of the column's largest: a pool seen from above fades before it ends.
/// @param level a signal of the pool; columns that do not reach it are left out.
PlateEdge find_plate_edge(const Stack& stack, double dark, double level, const Blur& blur);

/// The pool completed by its mirror image above the border, as if heat left neither half: lines
/// at half-integer distances from it, first divided by the part of the blur that met metal
/// (normalised convolution, Knutsson and Westin 1993), then interpolated. Twice as deep.
Stack mirrored(const Stack& stack, double dark, const PlateEdge& edge, const Blur& blur);

}  // namespace meltproof::imaging

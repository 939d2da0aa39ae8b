// SPDX-License-Identifier: GPL-3.0-or-later
// The mean pool without what optics, motion and pixels do to it.
#pragma once

#include "imaging/meltpool/plate_edge.hpp"
#include "imaging/meltpool/reference_signal.hpp"

namespace meltproof::imaging {

/// px.
struct PoolDraw {
  double length = 0, depth = 0;
};

/// Dimensions of the mean pool, px, before and after its blur is taken off. Positions along a line
/// of the stack.
struct CorrectedPool {
  double blurred_length = 0, blurred_depth = 0;  ///< of the stack at the level, as it is
  double onset = 0, u_onset = 0;                 ///< without blur
  double end = 0, u_end = 0;                     ///< without blur; the front, where it was found
  double depth = 0;                              ///< without blur
  double doubt_depth = 0;   ///< half of a width within which the extrapolation lies
  double by_log_level = 0;  ///< change of the length for one unit of ln(S - dark)
  double depth_by_log_level = 0;
  double by_blur = 0;         ///< change of the length for one px of the point spread's sigma
  double by_plate_edge = 0;   ///< change of the length for one px of the plate's border
  double misfit = 1;          ///< of the tail's fit, at least 1
  bool front_found = false;   ///< the end is the front of find_reference_signal()
  double u_sides = 0;         ///< of the depth, where the sides were fitted; else 0
  bool sides_fitted = false;  ///< the depth is between the sides of the blurred model
  /// Where a front was found: changes of length and depth for each draw of what the tail told, i.e.
  /// front, S* and point spread together.
  std::vector<PoolDraw> draws;
  double length() const { return onset - end; }
};

/// The plate's border of find_plate_edge(), moved to where the models of tail and leading edge fit
/// best (parabola through five places, 0.07 px apart).
PlateEdge refined_plate_edge(const Stack& stack, double dark, double level, const Blur& blur,
                             const PlateEdge& edge);

/// The ends by fit_edge() at the level. Where a front was `found` the tail's end is the front, and
/// the leading edge, in a top view the sides too, are fitted at S* with the law and the point
/// spread that the tail told. Otherwise the depth is measured on the stack smoothed once more by
/// 0.25, 0.75, 1.25 and 2 times the variance of its own blur and extrapolated by a parabola to none
/// (simulation extrapolation, Cook and Stefanski 1994); in a side view on the pool completed by its
/// mirror image.
/// @param level a contour's signal; a step in it is left aside.
/// @return nothing where an end cannot be fitted.
std::optional<CorrectedPool> corrected_pool(const Stack& stack, const Level& level, double dark,
                                            const Blur& blur, const PlateEdge& edge,
                                            const ReferenceSignal* found);

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// A model of the mean pool's tail with its solidification front, as the camera blurs it.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "imaging/meltpool/blur.hpp"
#include "imaging/meltpool/stack.hpp"
#include "imaging/meltpool/tail_law.hpp"

namespace meltproof::imaging {

/// One place along the line of the front: what the mean pool shows and what the model says.
struct TailSample {
  double position = 0;     ///< px along a line of the stack
  double seen = 0, u = 0;  ///< ln(S - dark) of the mean pool, its standard uncertainty
  double blurred = 0;      ///< ln(S - dark) of the model as the camera blurs it
  double sharp = 0;        ///< the same without the blur
};

/// What is known before a fit.
struct TailPriors {
  double u_variance = 0;                  ///< px^2, standard uncertainty of the blur's variance
  double steepness = steepness_of_steel;  ///< d ln S / d ln T at the liquidus
  double u_steepness = 0;                 ///< its standard uncertainty
  /// Interval of theta over which the alloy freezes and its standard uncertainty, where it is
  /// known.
  std::optional<std::pair<double, double>> interval;
};

/// One draw of what the tail tells, see blurred_fit::posterior().
struct TailDraw {
  double front = 0, log_signal = 0, variance = 0, ratio = 0, interval = 0;
};

/// theta(x, y) is smooth (a polynomial along and across the scan), TailLaw makes of it the signal,
/// and that is blurred before it is compared with the stack, so that front and signal are those
/// without blur. The front is the line theta(x, y) = theta*.
///
/// Freezing metal either releases heat that a camera can see, over an interval of 0.16 to 0.48
/// times the steepness in theta, or its signal steps abruptly. Both are fitted; values are means
/// over the draws of the likelier kind, and the uncertainties hold both kinds and every interval
/// with their weights. The blur's variance is fitted with the rest, within what is known of it.
struct TailModel {
  double log_signal = 0;                ///< theta*
  double rise = 0;                      ///< TailLaw::rise()
  double interval = 0;                  ///< of theta; 0: abrupt
  TailLaw law;                          ///< the fitted one
  double u_log_signal = 0, u_rise = 0;  ///< standard uncertainties
  double front = 0;                     ///< px along a line, outermost place of the front
  double u_front = 0;                   ///< px
  double variance = 0, u_variance = 0;  ///< px^2, what the fit adds to the blur's variance
  double blurred = 0;                   ///< ln(S - dark) that the blurred model has at that place
  double slope = 0;                     ///< of theta a pixel at that place, outwards: negative
  double abrupt = 0;                    ///< probability that the front is abrupt
  double misfit = 0;                    ///< chi-squared over degrees of freedom
  double explained = 0;              ///< chi-squared that the front explains, in units of `misfit`
  std::size_t lines = 0;             ///< lines of pixels that the front crosses within the fit
  std::vector<TailSample> profile;   ///< along the line of pixels next to the outermost front
  std::size_t lines_with_front = 0;  ///< of them, those where it explains chi-squared of 25 or more
  std::vector<TailDraw> draws;       ///< with what is known of the blur
};

/// Where metal begins across the scan: above `row` (px, line number and fraction) there is none.
struct PlateEdge {
  bool present = false;
  double row = 0, u_row = 0;
};

/// Fits the model to the part of the stack's tail around the signal `start` (ln(S - dark)), within
/// seven pixels of where the stack falls to it, with the likelier kind of front and without
/// uncertainties. @return nothing where that part is too small or the fit does not converge onto a
/// front within it. @param steps of Levenberg and Marquardt, at most.
std::optional<TailModel> fit_tail(const Stack& stack, double dark, const Blur& blur,
                                  const PlateEdge& edge, double start,
                                  const TailPriors& priors = {}, int steps = 60);

/// The same with 400 draws of what is known of front, signal and blur.
std::optional<TailModel> infer_tail(const Stack& stack, double dark, const Blur& blur,
                                    const PlateEdge& edge, double start, std::uint64_t seed,
                                    const TailPriors& priors = {});

/// An end of the mean pool without the blur.
struct SharpEdge {
  double position = 0;  ///< px along a line, outermost place; of a side the line and its fraction
  double u = 0;         ///< px, standard uncertainty by the noise that the fit leaves
  double misfit = 0;    ///< chi-squared over degrees of freedom
  /// Changes of the position for one unit of the level (with it of the law's theta*), of the law's
  /// ratio and interval, and of the blur's variance (px^2), along and across alike; to first order,
  /// the field being fitted anew.
  double by_log_level = 0, by_ratio = 0, by_interval = 0, by_variance = 0;
};

/// Where the mean pool ends at a signal, `log_level` = ln(S - dark), without the blur: the same
/// model without a front, fitted to the tail or to the leading edge. @param law the law of the tail
/// where it is known: metal melts at the leading edge as it freezes in the tail, and the level is
/// then that of liquid metal at its front. @return nothing where there are too few samples or the
/// field does not fall to the level within them.
std::optional<SharpEdge> fit_edge(const Stack& stack, double dark, const Blur& blur,
                                  const PlateEdge& edge, double log_level, bool leading,
                                  const TailLaw* law = nullptr);

/// The same across the scan, where the pool is widest. @param side +1 towards higher lines, -1
/// towards lower ones.
std::optional<SharpEdge> fit_side(const Stack& stack, double dark, const Blur& blur,
                                  const PlateEdge& edge, double log_level, int side,
                                  const TailLaw* law = nullptr);

}  // namespace meltproof::imaging

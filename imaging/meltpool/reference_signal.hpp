// SPDX-License-Identifier: GPL-3.0-or-later
// The signal of the phase boundary, found in the recording itself.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "imaging/meltpool/tail_model.hpp"

namespace meltproof::imaging {

/// What must hold before a feature of the tail is taken for the solidification front.
struct ReferenceRules {
  /// Height of the feature in ln S: a third of the 0.4 of an emissivity that steps from 0.2 to 0.3
  /// and of what the latent heat of steel amounts to.
  double prominence = 0.15;
  double significance = 5;  ///< that height over its standard uncertainty
  /// Least part of its slope that the signal loses within the feature. Released heat takes 0.8 and
  /// more of it in steel, a step of the emissivity more than all; a smooth tail that the polynomial
  /// does not quite follow takes up to 0.45 (measured on Rosenthal's pool).
  double flattening = 0.6;
  /// Largest interval of ln S, over d ln S / d ln T: the freezing heat of steel has 0.2, and wider
  /// features are no front.
  double widest = 0.44;
  std::size_t fewest_lines = 3;  ///< lines of pixels in which the feature is significant
  double share = 0.5;            ///< and their part of all lines that the front crosses
  double misfit = 4;             ///< largest chi-squared over degrees of freedom
  double u_front = 0.75;         ///< px, largest standard uncertainty of the front's place
  /// Largest half width of the length's 95 % interval, over the length. A length that is known less
  /// well is not given as independent of the emissivity. Of 200 scenes 176 are given with 3 %, all
  /// within 3 %, and 124 with 1.33 %, all within 2 % (camera/coverage_test.cpp).
  double uncertainty = 0.03;
  /// Heat that the alloy gives off from liquidus to solidus, over specific heat times liquidus:
  /// 0.19 to 0.23 for 316L (274.7 kJ/kg; 847 to 714 J/(kg K), 1683 K). It holds the latent heat
  /// and what cools the metal from liquidus to solidus. Nothing: 0.16 to 0.48 are alike.
  std::optional<double> freezing_heat;
  double u_freezing_heat = 0.15;  ///< its standard uncertainty, relative
};

/// Which sign of solidification was seen.
enum class Signature { none, latent_heat, emissivity };
/// "none", "latent heat" or "emissivity".
std::string signature_name(Signature signature);

/// The reference signal, or why there is none.
struct ReferenceSignal {
  Signature signature = Signature::none;
  std::string reason;         ///< for none, one sentence
  double signal = 0;          ///< S* of liquid metal at the front, the recording's unit, with dark
  double relative_u = 0;      ///< standard uncertainty of ln(S* - dark)
  double solid_signal = 0;    ///< the same of solid metal, where the emissivity steps; else 0
  double blurred_signal = 0;  ///< what the blurred recording shows at the front
  double front = 0;           ///< px along a line of the stack, outermost place of the front
  double u_front = 0;         ///< px
  TailModel model;            ///< where one was fitted
};

/// Looks for the front in the tail of the mean pool: fits TailModel from signals between 0.7 and
/// 0.06 of the brightest one, keeps the fit that explains most, fits again around its front, and
/// applies the rules. The feature counts as a step of the emissivity where the signal rises within
/// it, otherwise as latent heat.
/// The point spread is fitted with the rest, `u_point_spread` (px) being what is known of it
/// beforehand, so that the uncertainties of S* and of the front hold it.
/// @param steepness d ln S / d ln T at the liquidus; tells how the signal of solid metal goes on
/// behind released heat, and needs neither emissivity nor transmission. @param u_steepness of it.
/// @param dark signal without light; @param seed of the draws.
ReferenceSignal find_reference_signal(const Stack& stack, double dark, const Blur& blur,
                                      const PlateEdge& edge, double u_point_spread = 0,
                                      const ReferenceRules& rules = {}, std::uint64_t seed = 1,
                                      double steepness = steepness_of_steel,
                                      double u_steepness = 0);

/// Emissivities that S* implies at a reference temperature, S* = gain t_int tau (eps L + ...) +
/// dark inverted for eps, and whether they are those of a metal.
struct ImpliedEmissivity {
  double liquid = 0;
  std::optional<double> solid;
  static constexpr double least = 0.05, most = 0.8;
  bool believable() const {
    const auto within = [](double e) { return e >= least && e <= most; };
    return within(liquid) && (!solid || within(*solid));
  }
};
/// @param reference_temperature K.
ImpliedEmissivity implied_emissivity(const ReferenceSignal& found, const Radiometry& radiometry,
                                     double reference_temperature);

}  // namespace meltproof::imaging

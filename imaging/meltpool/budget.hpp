// SPDX-License-Identifier: GPL-3.0-or-later
// The uncertainty of a recording's mean length and depth (GUM; JCGM 100 and, for the propagation by
// Monte Carlo, JCGM 101).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "imaging/meltpool/correction.hpp"

namespace meltproof::imaging {

/// What is known of the inputs. Standard uncertainties.
struct BudgetSettings {
  double point_spread = 0.8;           ///< px, sigma of a Gaussian
  double u_point_spread = 0.1;         ///< px
  double u_integration_time = 0.01;    ///< 1, relative
  double u_reference_temperature = 5;  ///< K: how well composition fixes the liquidus
  /// 1, relative, where the level rests on an emissivity. Nothing: u_assumed_emissivity().
  std::optional<double> u_emissivity;
  double u_transmission = 0.01;   ///< 1, relative, where the level rests on it
  double u_level = 0;             ///< 1, relative, of a level that was given
  double non_uniformity = 0.005;  ///< 1, standard deviation between the pixels' gains
  long long draws = 1000;
  std::uint64_t seed = 1;
};

/// One row of the budget. Lengths in the analysis' unit.
struct Contribution {
  std::string name;
  std::string type;  ///< "A" by statistics of this recording, "B" otherwise
  double u_length = 0, u_depth = 0;
  double correction_length = 0, correction_depth = 0;  ///< added to the mean over frames
  std::string how;
};

/// A mean value with what was corrected and its interval.
struct Estimate {
  double value = 0, u = 0;
  double low = 0, high = 0;  ///< the middle 95 % of the draws
};

/// The budget of a recording.
struct Budget {
  bool corrected = false;  ///< blur and noise were taken off
  std::string reason;      ///< why not, one sentence
  Estimate length, depth;
  std::vector<Contribution> rows;
  double blur_along = 0, blur_across = 0;  ///< px, sigma of all that blurs
  bool plate_edge = false;                 ///< a side view
  double plate_row = 0;                    ///< px from the image's first border
};

/// Adds up what is uncertain, by draws from every input at once; every row is the standard
/// deviation of the draws of that input alone. Deterministic for a seed.
/// @param stack of the same recording, or null with a reason; @param found may be null.
Budget uncertainty_budget(const Recording& recording, const Analysis& analysis,
                          const PixelSize& pixel, const Stack* stack, const std::string& no_stack,
                          const ReferenceSignal* found, const BudgetSettings& settings);

}  // namespace meltproof::imaging

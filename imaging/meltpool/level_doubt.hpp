// SPDX-License-Identifier: GPL-3.0-or-later
// How uncertain the level is at which a pool ends, and what that makes of its dimensions.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "imaging/meltpool/level.hpp"
#include "imaging/meltpool/uneven_pixels.hpp"

namespace meltproof::imaging {

struct BudgetSettings;

/// Limits between which emissivities of clean liquid metals between 3 and 5 um are published, 1.
inline constexpr double least_published_emissivity = 0.15, most_published_emissivity = 0.5;

/// Standard uncertainty of ln(emissivity), 1, of one that somebody assumes: half its distance from
/// the farther end of what is published, so that two of them reach as far as a metal may be. 0.35
/// for an emissivity of 0.3; never less than 0.30.
/// @param emissivity 1, positive.
double u_assumed_emissivity(double emissivity);

/// What is known of a level.
struct LevelDoubt {
  double u_log = 0;  ///< standard uncertainty of its ln(S - dark), 1
  std::string how;   ///< what it is made of
};
/// A level by a reference temperature rests on that temperature, on an emissivity and on the
/// windows' transmission. In a recording of temperatures the camera's software has used an
/// emissivity, and a temperature is wrong by its error over d ln S / d ln T, taken to be
/// steepness_of_steel.
/// @param u_reference_signal standard uncertainty of ln(S* - dark), of a level that was found in
/// the recording, 1.
LevelDoubt level_doubt(const RecordingHeader& header, const Level& level,
                       const BudgetSettings& settings, double u_reference_signal);

/// Dimensions as a function of the level. What is not known of an emissivity moves the level so far
/// (a factor of two) that the dimensions follow no straight line, so the pool is measured anew at
/// levels up to three standard uncertainties to either side, half of one apart.
class LevelEffect {
 public:
  /// Dimensions at a level whose ln(S - dark) is raised by a number: zero where nothing reaches it,
  /// nothing where they cannot be measured because the region leaves the image.
  using SizeAt = std::function<std::optional<Effect>(double)>;
  /// @param u_log standard uncertainty of ln(S - dark), 1; with 0 there is no effect.
  /// @param seen dimensions at the level itself, where size_at(0) cannot be measured.
  LevelEffect(double u_log, const Effect& seen, const SizeAt& size_at);
  /// What the dimensions differ by from those at the level itself if its ln(S - dark) is raised by
  /// `shift`: straight lines between the levels that were measured, and a straight line of ln of a
  /// dimension beyond them.
  Effect operator()(double shift) const;

 private:
  double along(double shift, double Effect::*dimension) const;
  struct Node {
    double shift;
    Effect size;
  };
  std::vector<Node> nodes_;  ///< by rising shift
  Effect at_level_;
};

}  // namespace meltproof::imaging

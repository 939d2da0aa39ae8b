// SPDX-License-Identifier: GPL-3.0-or-later
// A recording from frames to dimensions with their uncertainty: the steps of analysis, reference
// signal and budget in their order.
#pragma once

#include <optional>
#include <string>

#include "imaging/meltpool/budget.hpp"

namespace meltproof::imaging {

/// Whether the signal of the phase boundary is looked for in the recording.
enum class ReferenceSearch {
  /// and used where it is found, unless a level or an emissivity was given; where it is vague, only
  /// if the length would be less well known without it
  automatic,
  required,  ///< and there is no result without it
  off
};
/// "auto", "find" or "off". @throws InputError otherwise.
ReferenceSearch parse_reference_search(const std::string& text);

/// Everything that a measurement needs besides the recording.
struct MeasurementRequest {
  LevelRequest level;
  std::optional<double> dark;  ///< signal without light, for recordings of bare counts
  ReferenceSearch search = ReferenceSearch::automatic;
  ReferenceRules rules;
  ScanDirection direction = ScanDirection::right;
  PixelSize pixel;
  BudgetSettings budget;
};

/// What a recording gives.
struct Measurement {
  Analysis analysis;
  ReferenceSignal reference;  ///< with a reason where none was found, used or looked for
  bool reference_used = false;
  /// Where S* is used although it places the front less well than ReferenceRules::uncertainty
  /// allows, because what there is otherwise knows the length even less: how well it does.
  std::string vague;
  std::optional<ImpliedEmissivity> emissivity;  ///< where S* was found and the radiometry is known
  std::optional<Budget> budget;                 ///< where there is a pool
  /// Whether the outline depends on no emissivity and no transmission.
  bool emissivity_independent() const { return reference_used; }
};

/// Finds the pool at the best level that the request allows, averages it in its own frame, looks
/// for the reference signal there and, where it is found, finds the pool anew at it.
/// @throws InputError as find_level().
Measurement measure_recording(const Recording& recording, const MeasurementRequest& request);

}  // namespace meltproof::imaging

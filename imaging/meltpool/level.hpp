// SPDX-License-Identifier: GPL-3.0-or-later
// At which signal the melt pool ends, and whether there is a melt pool at all.
#pragma once

#include <optional>
#include <string>

#include "imaging/meltpool/contour.hpp"
#include "imaging/meltpool/front.hpp"
#include "imaging/recording/recording.hpp"

namespace meltproof::imaging {

/// What the user says about the level; what is not said is found.
struct LevelRequest {
  std::optional<double> level;                  ///< in the recording's own unit
  std::optional<double> reference_temperature;  ///< K
  std::optional<double> emissivity;             ///< of solid metal, instead of the recording's
  std::optional<double> emissivity_liquid;      ///< of liquid metal, instead of the recording's
  std::optional<double> transmission;           ///< of the windows, instead of the recording's
};

/// Liquidus of 316L in the paper's table of properties, K: the reference temperature unless one is
/// given.
inline constexpr double default_reference_temperature = 1683;

/// How the level was found: from the best kind of knowledge to the poorest.
enum class LevelKind {
  given,        ///< the user's number
  temperature,  ///< the reference temperature, in a recording of temperatures
  recording,    ///< found in the recording itself: no emissivity, no transmission
  radiometry,   ///< the reference temperature through Planck's law over the camera's band
  contrast      ///< the threshold between a bright region and its background: no phase boundary
};
std::string level_kind_name(LevelKind kind);

/// The level, or why there is no melt pool.
struct Level {
  LevelKind kind = LevelKind::contrast;
  std::optional<double>
      value;           ///< in the recording's unit; nothing: no frame passed the contrast rule
  std::string how;     ///< one sentence
  std::string reason;  ///< why there is no value, one sentence
  double reference_temperature = 0;  ///< K; 0 where none was used
  double emissivity = 0;  ///< of liquid metal, 1, that a level by radiometry rests on; else 0
  Interpolation interpolation;
  std::optional<EmissivityStep>
      step;  ///< where the emissivities of both phases are known and differ
};

/// A region smaller than this has no shape to measure: the smallest square of pixels.
inline constexpr std::size_t smallest_pool = 4;
/// What a bright region must be to be taken for a melt pool by contrast alone. See
/// imaging/README.md.
struct ContrastRule {
  double prominence = 10;  ///< level above the background, in standard deviations of the background
  double contrast = 2;     ///< mean of the bright region over the background
  double compactness = 0.5;  ///< Region::compactness()
};

/// The contrast rule applied to one frame.
struct Contrast {
  bool passed = false;
  double level = 0;       ///< Otsu's threshold (1979): least variance within bright and dark pixels
  double background = 0;  ///< median
  double noise = 0;       ///< 1.4826 times the median absolute deviation, at least half a count
  double prominence = 0;  ///< (level - background) / noise
  double contrast = 0;    ///< mean of the bright pixels / background
  std::string reason;     ///< what the frame lacks, a clause that follows "because"
};
/// @param frame a frame of counts; dead pixels are left out.
Contrast contrast(const Frame& frame, RegionFinder& finder, const ContrastRule& rule = {});

/// Finds the level of a recording. Only the contrast rule reads frames.
/// @throws InputError if the request does not fit what the recording holds.
Level find_level(const Recording& recording, const LevelRequest& request);

/// The level, and the step in it, with another ln(S - dark).
/// @param shift what is added to it, 1. @param level one with a value.
Level raised(Level level, double shift);

/// A sentence for a recording whose brightest value stays below the level.
std::string below_level_reason(const RecordingHeader& header, const Level& level, double highest,
                               std::size_t frame);

}  // namespace meltproof::imaging

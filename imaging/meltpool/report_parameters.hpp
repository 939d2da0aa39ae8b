// SPDX-License-Identifier: GPL-3.0-or-later
// Every parameter that the measurement rests on, and who says so.
#pragma once

#include <nlohmann/json.hpp>

#include "imaging/meltpool/settings.hpp"

namespace meltproof::imaging {

/// A row a parameter: `name`, `value` (null where nobody knows it), `unit` and `source`: "given" by
/// the user, "calibration", "file", "default", or "unknown". `pixel` and `point_spread` are those
/// that the measurement used.
nlohmann::json parameters_json(const RecordingHeader& header, const Settings& settings,
                               const PixelSize& pixel, const PointSpread& point_spread);

/// tail.csv: along the line of pixels next to the outermost front, by the distance from it (towards
/// the beam positive), what the mean pool shows and what the model says. Empty without a model.
std::string tail_table(const Measurement& measurement, const PixelSize& pixel);

}  // namespace meltproof::imaging

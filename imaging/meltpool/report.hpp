// SPDX-License-Identifier: GPL-3.0-or-later
// The tables that thermography leaves behind.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "base/provenance.hpp"
#include "imaging/meltpool/settings.hpp"

namespace meltproof::imaging {

/// summary.json: the recording, the level, the melt pool with its uncertainty, and where it all
/// comes from. A number that is unknown is null.
nlohmann::json summary(const Recording& recording, const Measurement& measurement,
                       const PixelSize& pixel, const Settings& settings,
                       const Provenance& provenance);

/// frames.csv: one row per frame, the unit of each column in its header.
std::string frames_table(const Recording& recording, const Analysis& analysis);

/// A few lines for a person.
std::string spoken(const Recording& recording, const Measurement& measurement);

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// A measured length or depth from recordings that meltproof-thermography evaluated.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "validation/dataset.hpp"

namespace meltproof::validation {

/// What several tracks, one recording each, say of one quantity.
struct RecordedQuantity {
  Datum datum;             ///< mean over the tracks and u_D, in um
  double scatter = 0;      ///< its part from frames and tracks
  double systematic = 0;   ///< its part from the budget of the thermography
  bool synthetic = false;  ///< some recording says that it is synthetic
};

/// Mean of `quantity` ("length" or "depth") over the summaries. Where a summary has a budget, its
/// corrected value counts, else the mean over its frames. u_D^2 = scatter^2 + systematic^2: scatter
/// is the standard deviation between tracks over sqrt(n), of a single track the type A part of its
/// budget (or its scatter between frames); systematic is the root mean square over the tracks of
/// the type B parts, which all tracks of one set-up share.
/// @throws InputError for a file that is missing, no summary, or without the quantity in um.
RecordedQuantity recorded_quantity(const std::vector<std::filesystem::path>& summaries,
                                   const std::string& quantity);

}  // namespace meltproof::validation

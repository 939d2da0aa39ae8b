// SPDX-License-Identifier: GPL-3.0-or-later
// What the values of a general-purpose file are, from the name of their unit.
#pragma once

#include <string>
#include <vector>

#include "imaging/recording/recording.hpp"

namespace meltproof::imaging {

/// stored value * factor + offset is the value in the header's unit.
struct SignalScale {
  float factor = 1, offset = 0;
  void apply(std::vector<float>& values) const;
};

/// Fills quantity and unit of the header from the unit that the user gives, or else the one that
/// the file names: count, K, degC, degF or W m-2 sr-1, in their usual spellings. Where neither is
/// known the values are counts, and a note says so.
/// @throws InputError if the user's unit is none of them.
SignalScale describe_signal(const std::string& in_file, const std::string& from_user,
                            RecordingHeader& header);

}  // namespace meltproof::imaging

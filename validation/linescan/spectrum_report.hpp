// SPDX-License-Identifier: GPL-3.0-or-later
// What a single file of an EDS program holds, for a person.
#pragma once

#include <filesystem>
#include <string>

#include "validation/linescan/measured_line.hpp"

namespace meltproof::validation {

/// A few lines of text: the spectrum with the counts in its windows (net counts with their noise
/// sqrt(N + 2B), which are no composition), the vendor's composition in wt% and at% with the
/// concentrations of AlSi10Mg that it gives, or the extent of a line or map.
/// @throws InputError as read_eds_export().
std::string describe_export(const MeasuredRequest& request);

}  // namespace meltproof::validation

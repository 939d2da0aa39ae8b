// SPDX-License-Identifier: GPL-3.0-or-later
// EMSA/MAS spectra (.msa, .emsa; ISO 22029).
#pragma once

#include <filesystem>
#include <string_view>

#include "validation/eds/spectrum.hpp"

namespace meltproof::validation {

/// A text that begins with the keyword #FORMAT and names EMSA/MAS.
bool is_msa(std::string_view first_bytes);

/// Header lines "#KEYWORD : value" up to #SPECTRUM, then the counts (#DATATYPE Y) or pairs of
/// energy and counts (XY), separated by commas, blanks or line ends, up to #ENDOFDATA. Energies in
/// eV or keV; lengths (um, nm) make it a line of one element.
/// @throws InputError naming the keyword or line for: a required keyword missing or no number, an
/// unknown unit or data type, fewer or more values than #NPOINTS, a missing end, uneven energies.
Spectrum read_msa(const std::filesystem::path& path);

}  // namespace meltproof::validation

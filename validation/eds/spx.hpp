// SPDX-License-Identifier: GPL-3.0-or-later
// Bruker's spectra (.spx), with the composition that Esprit made of them.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "validation/eds/spectrum.hpp"

namespace meltproof::validation {

/// XML whose root is TRTSpectrum.
bool is_spx(std::string_view first_bytes);

struct SpxContent {
  Spectrum spectrum;
  std::optional<PointComposition> composition;  ///< if the file was saved with a quantification
};

/// Channels, calibration and, where there is a TRTResult, atom and mass fractions with the net and
/// background counts of each line. Fractions add to about 1; a sum above 2 can only be percent and
/// is read so. <Sigma> is passed over: what it is a deviation of is not documented.
/// @throws InputError for XML that is damaged or cut off, missing channels or calibration, fewer
/// channels than announced, an element that is not known, or what is no number.
SpxContent read_spx(const std::filesystem::path& path);

}  // namespace meltproof::validation

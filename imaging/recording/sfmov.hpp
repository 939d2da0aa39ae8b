// SPDX-License-Identifier: GPL-3.0-or-later
// FLIR SFMOV: the export of FLIR's research software, with its .inc file beside it.
#pragma once

#include <filesystem>
#include <string_view>

#include "imaging/recording/recording.hpp"

namespace meltproof::imaging {

/// Whether a text with the key xPixls begins the file.
bool is_sfmov(std::string_view first_bytes);
/// Counts, or apparent temperatures in K where the .inc file holds a calibration.
/// @throws InputError if the header is damaged or the type of the pixels is unknown.
Recording open_sfmov(const std::filesystem::path& path);

}  // namespace meltproof::imaging

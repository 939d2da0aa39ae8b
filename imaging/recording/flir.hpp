// SPDX-License-Identifier: GPL-3.0-or-later
// FLIR FFF, SEQ and CSQ: one block a frame, each with its own directory of records.
#pragma once

#include <filesystem>
#include <string_view>

#include "imaging/recording/bytes.hpp"
#include "imaging/recording/recording.hpp"

namespace meltproof::imaging {

/// Whether a file begins with FFF or AFF.
bool is_flir(std::string_view first_bytes);
/// Temperatures in K by FLIR's formula, or counts where the camera stored no calibration.
/// @throws InputError if the file is damaged or compressed in an unknown way.
Recording open_flir(const std::filesystem::path& path);
/// The same for blocks that were taken out of another file.
Recording open_flir_blocks(const ByteFile& file);

}  // namespace meltproof::imaging

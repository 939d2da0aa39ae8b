// SPDX-License-Identifier: GPL-3.0-or-later
// FLIR radiometric JPEG: a picture for the eye that carries a FLIR block for the scale.
#pragma once

#include <filesystem>
#include <string_view>

#include "imaging/recording/recording.hpp"

namespace meltproof::imaging {

/// Whether a file begins as every JPEG does.
bool is_flir_jpeg(std::string_view first_bytes);
/// One frame of temperatures. @throws InputError if the picture carries no FLIR block, or not all
/// of it.
Recording open_flir_jpeg(const std::filesystem::path& path);

}  // namespace meltproof::imaging

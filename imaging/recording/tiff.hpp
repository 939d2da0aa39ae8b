// SPDX-License-Identifier: GPL-3.0-or-later
// TIFF: pages of one channel, integer or float, read one at a time by libtiff.
#pragma once

#include <filesystem>
#include <string_view>

#include "imaging/recording/recording.hpp"

namespace meltproof::imaging {

bool is_tiff(std::string_view first_bytes);
Recording open_tiff(const std::filesystem::path& path);

}  // namespace meltproof::imaging

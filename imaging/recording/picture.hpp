// SPDX-License-Identifier: GPL-3.0-or-later
// BMP and PNG: one grey picture, read by OpenCV, as a recording of one frame.
#pragma once

#include <filesystem>
#include <string_view>

#include "imaging/recording/recording.hpp"

namespace meltproof::imaging {

bool is_picture(std::string_view first_bytes);
Recording open_picture(const std::filesystem::path& path);

}  // namespace meltproof::imaging

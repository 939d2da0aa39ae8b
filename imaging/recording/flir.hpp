// SPDX-License-Identifier: GPL-3.0-or-later
// FLIR FFF and SEQ: one block a frame, each with its own directory of records.
#pragma once

#include <filesystem>
#include <string_view>

#include "imaging/recording/recording.hpp"

namespace meltproof::imaging {

bool is_flir(std::string_view first_bytes);
Recording open_flir(const std::filesystem::path& path);

}  // namespace meltproof::imaging

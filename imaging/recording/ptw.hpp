// SPDX-License-Identifier: GPL-3.0-or-later
// Cedip PTW: the recordings of Cedip and early FLIR science cameras.
#pragma once

#include <filesystem>
#include <string_view>

#include "imaging/recording/recording.hpp"

namespace meltproof::imaging {

bool is_ptw(std::string_view first_bytes);
Recording open_ptw(const std::filesystem::path& path);

}  // namespace meltproof::imaging

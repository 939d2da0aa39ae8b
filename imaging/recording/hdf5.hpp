// SPDX-License-Identifier: GPL-3.0-or-later
// Our own recording.h5, which the virtual camera writes.
#pragma once

#include <filesystem>
#include <string_view>

#include "imaging/recording/recording.hpp"

namespace meltproof::imaging {

bool is_hdf5(std::string_view first_bytes);
Recording open_hdf5(const std::filesystem::path& path);

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// HDF5: this suite's own recordings, and arrays of frames in the files of others.
#pragma once

#include <filesystem>
#include <string_view>

#include "imaging/recording/options.hpp"
#include "imaging/recording/recording.hpp"

namespace meltproof::imaging {

/// Whether HDF5's mark begins the file.
bool is_hdf5(std::string_view first_bytes);
/// An artifact of the kind "meltproof recording", or else what open_hdf5_array() finds.
/// @throws InputError if it is another artifact of this suite, or holds no frames.
Recording open_hdf5(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace meltproof::imaging

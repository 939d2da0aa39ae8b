// SPDX-License-Identifier: GPL-3.0-or-later
// MATLAB's files: version 7.3, which is HDF5 behind 512 bytes of text, and version 5 before it.
#pragma once

#include <filesystem>
#include <string_view>

#include "imaging/recording/options.hpp"
#include "imaging/recording/recording.hpp"

namespace meltproof::imaging {

/// Whether the words MATLAB 7.3 begin the file.
bool is_matlab_7(std::string_view first_bytes);
/// An array frames(row, column, frame) unless options.axes says otherwise, see open_hdf5_array().
Recording open_matlab_7(const std::filesystem::path& path, const ReadOptions& options = {});

/// Whether the words MATLAB 5.0 begin the file.
bool is_matlab_5(std::string_view first_bytes);
/// The same for the older format: options.dataset, or the only variable of numbers with three
/// dimensions (of two where there is none with three: one frame).
/// @throws InputError if there is none or more than one, or if the file is damaged.
Recording open_matlab_5(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// Frames in a three-dimensional data set of any HDF5 file.
#pragma once

#include <filesystem>
#include <string>

#include "imaging/recording/options.hpp"
#include "imaging/recording/recording.hpp"

namespace meltproof::imaging {

/// Opens options.dataset, or the only data set of numbers with three dimensions (of two where there
/// is none with three: one frame). Its indices count options.axes, or `default_axes`.
/// @param reversed whether the file's own language writes the indices in the other order than HDF5
/// stores them, as MATLAB does; axes and shapes in messages are then in that language's order.
/// @throws InputError if there is no such data set or more than one, if it holds no numbers, or if
///         its size cannot be.
Recording open_hdf5_array(const std::filesystem::path& path, const ReadOptions& options,
                          const std::string& default_axes, bool reversed);

}  // namespace meltproof::imaging

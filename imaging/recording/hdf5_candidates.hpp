// SPDX-License-Identifier: GPL-3.0-or-later
// The data sets of an HDF5 file that may hold frames.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/artifact_hdf5.hpp"

namespace meltproof::imaging {

/// Whether a data set holds integers or floating-point numbers.
bool hdf5_holds_numbers(hid_t set);
/// The shape of a data set as HDF5 stores it.
std::vector<hsize_t> hdf5_dims(hid_t set);
/// "5 x 6 x 9", in the order of the file's own language.
std::string hdf5_shape_text(std::vector<hsize_t> dims, bool reversed);

/// The only array of numbers with three dimensions by its path; where there is none, the only one
/// with two, or those with two that are the frames of one recording, in order.
/// @throws InputError if there is none, or if the choice is the user's.
std::vector<std::string> choose_hdf5_arrays(const std::filesystem::path& path, hid_t file,
                                            bool reversed);

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// A folder whose files are the frames of one recording, or the parts that software split it into.
#pragma once

#include <filesystem>
#include <string>

#include "imaging/recording/options.hpp"
#include "imaging/recording/recording.hpp"

namespace meltproof::imaging {

/// Whether `a` comes before `b` when numbers in names count as numbers: frame_2 before frame_10.
bool natural_order(const std::string& a, const std::string& b);

/// The files of a folder with the one extension of a camera format that is in it, in natural order
/// of their names; each is read by its own reader when its frames are asked for.
/// @throws InputError if there are none, if extensions are mixed, or if the files differ in size of
///         a frame or quantity.
Recording open_folder(const std::filesystem::path& path, const ReadOptions& options);

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// Frames written out as text, as the software of most makers exports them.
#pragma once

#include <filesystem>
#include <string_view>

#include "imaging/recording/options.hpp"
#include "imaging/recording/recording.hpp"

namespace meltproof::imaging {

/// Whether the bytes are text with a row of numbers in it.
bool is_csv(std::string_view first_bytes);

/// A frame is a block of rows of one length, without a blank line or a line of text in it; blocks
/// in front of the first frame that have another shape belong to the preamble. Where nothing
/// separates frames, options.frame_rows says how many rows one has.
/// @throws InputError if the blocks differ in shape, naming the line.
Recording open_csv(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace meltproof::imaging

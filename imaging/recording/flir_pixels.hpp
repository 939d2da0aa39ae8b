// SPDX-License-Identifier: GPL-3.0-or-later
// The counts of a FLIR frame, however they are compressed.
#pragma once

#include <cstddef>
#include <vector>

#include "imaging/recording/flir_block.hpp"

namespace meltproof::imaging {

/// Whether the 16-bit samples of a frame have their bytes the wrong way round. Most FLIR cameras
/// and programs write PNG so and some do not, and nothing in the file tells; other codings are
/// doubted only where the file contradicts itself (raw) or the picture is torn (JPEG-LS). The rule:
/// the right order is the one in which neighbours in a row differ less, summed over the frame,
/// because a sensor's noise fills the low byte. Equal sums count as exchanged for PNG; JPEG-LS,
/// whose coder would make such a picture larger than it was, counts as exchanged from a factor of
/// four on.
/// @throws InputError if the frame cannot be decoded.
bool flir_bytes_are_exchanged(const ByteFile& file, const FlirBlock& block, std::size_t frame);

/// Reads the counts of a frame, row-major, into `counts`, which has height * width values already.
/// @param exchanged what flir_bytes_are_exchanged() says.
/// @throws InputError if the record cannot be decoded or has another size than the block says.
void read_flir_counts(const ByteFile& file, const FlirBlock& block, bool exchanged,
                      std::size_t frame, std::vector<float>& counts);

}  // namespace meltproof::imaging

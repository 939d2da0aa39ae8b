// SPDX-License-Identifier: GPL-3.0-or-later
// The outline of a MATLAB 5 file, checked before matio is let near it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "imaging/recording/bytes.hpp"

namespace meltproof::imaging {

/// One variable of the file as its element says.
struct Mat5Element {
  std::uint64_t place = 0, length = 0;  ///< of its content in the file, bytes
  bool compressed = false;
  std::string name;
  /// Of the numbers, bytes; 0 if there are none. If compressed: after decompression, and the place
  /// means nothing in the file.
  std::uint64_t data_place = 0, data_length = 0;
};

/// The variables that the file holds or has begun; only the last one may be cut off by the end of
/// the file.
/// @throws InputError if an element cannot be what it says.
std::vector<Mat5Element> read_mat5_elements(const ByteFile& file);

}  // namespace meltproof::imaging

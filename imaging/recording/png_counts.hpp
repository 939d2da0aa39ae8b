// SPDX-License-Identifier: GPL-3.0-or-later
// A PNG of one 16-bit grey channel, as cameras embed it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meltproof::imaging {

/// What a PNG says of itself in its first chunk.
struct PngHeader {
  std::uint32_t width = 0, height = 0;
  unsigned bits = 0;    ///< per sample
  unsigned colour = 0;  ///< 0 is grey
};

/// The header of a PNG, or nothing if these bytes are none or too few.
std::optional<PngHeader> png_header(std::string_view bytes);

/// Whether the PNG's chunks follow each other without a gap from the header to the end mark and
/// every checksum is right. What is not so, OpenCV fills with zeros and says nothing.
bool png_is_whole(std::string_view bytes);

/// Decodes into `counts`, which has width * height values already, row-major.
/// @returns nothing, or what is wrong, as the end of a sentence ("ends early").
std::string decode_png_counts(const std::string& bytes, std::size_t width, std::size_t height,
                              std::vector<float>& counts);

}  // namespace meltproof::imaging

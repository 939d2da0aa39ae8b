// SPDX-License-Identifier: GPL-3.0-or-later
// The values of a TIFF page, however they are stored.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <tiffio.h>

#include "imaging/recording/recording.hpp"

namespace meltproof::imaging {

/// How the pixels of a page are stored.
struct TiffLayout {
  std::uint32_t width = 0, height = 0;
  std::uint16_t bits = 0, format = SAMPLEFORMAT_UINT;
  bool white_is_zero = false;  ///< counts run the other way (MinIsWhite)
  bool operator==(const TiffLayout&) const = default;
  /// Bytes of a row of `pixels` pixels: samples of 9 to 15 bits are packed, rows begin at a byte.
  std::size_t row_bytes(std::size_t pixels) const { return (pixels * bits + 7) / 8; }
};

/// A TIFF open for reading, and what libtiff last complained of.
struct TiffHandle {
  std::shared_ptr<TIFF> tiff;
  std::shared_ptr<std::string> last_error;
};

/// @throws InputError if the TIFF cannot be opened.
TiffHandle open_tiff_handle(const std::filesystem::path& path, std::uint64_t file_size);

/// The layout of the current page; nothing if it is coloured.
/// @throws InputError if its samples are of another kind than can be read.
std::optional<TiffLayout> tiff_layout(TIFF* t, const std::filesystem::path& path, std::size_t page);

/// Whether `bytes` in memory can come out of a file of that size by any usual compression.
bool tiff_can_hold(std::uint64_t bytes, std::uint64_t file_size);

/// Reads the current page into frame.values. @throws InputError if it cannot be decoded.
void read_tiff_page(const TiffHandle& tiff, const std::filesystem::path& path,
                    std::uint64_t file_size, const TiffLayout& layout, Frame& frame);

/// `count` values of one row in the byte order of this machine as numbers.
void convert_tiff_row(const char* raw, std::size_t count, const TiffLayout& layout, float* into);

}  // namespace meltproof::imaging

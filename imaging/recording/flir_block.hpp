// SPDX-License-Identifier: GPL-3.0-or-later
// One block of a FLIR file: where its pixels lie and what the camera says of itself.
#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "imaging/recording/bytes.hpp"
#include "imaging/recording/flir_temperature.hpp"

namespace meltproof::imaging {

/// A record in the directory of a block. `length` is 0 where the block has no such record.
struct FlirRecord {
  std::uint64_t place = 0;   ///< byte of the file
  std::uint64_t length = 0;  ///< bytes
  std::uint16_t subtype = 0;
};

/// How the pixels of a block are stored.
enum class FlirCoding { raw, png, jpeg_ls };

/// A block is one frame.
struct FlirBlock {
  FlirRecord raw, camera;
  std::uint64_t end = 0;  ///< where the next block begins
  std::size_t width = 0, height = 0;
  std::endian header_order = std::endian::little;  ///< of header and directory
  std::endian order = std::endian::little;         ///< of raw pixels, as their record says
  /// The subtype of the raw record means the other order; which is right has to be judged.
  bool order_in_doubt = false;
  FlirCoding coding = FlirCoding::raw;
};

/// The bytes of a raw record in front of its pixels.
constexpr std::uint64_t flir_raw_header = 32;

/// What a block says of camera, object and air.
struct FlirCamera {
  FlirConstants constants;
  /// Since 1970, an integer: a double would round the differences. Nothing: the record ends before.
  std::optional<std::int64_t> milliseconds;
  double frame_rate = 0;                  ///< Hz; 0: the record does not say
  double saturated = 0, under_range = 0;  ///< K
};

/// Whether these bytes begin a block.
bool begins_flir_block(std::string_view bytes);

/// Where the next block of frames like `like` begins at or behind `from`: some software leaves
/// bytes between frames. Only for places behind a block, since the magic also occurs inside pixels.
std::optional<std::uint64_t> find_flir_block(const ByteFile& file, std::uint64_t from,
                                             const FlirBlock& like, std::size_t frame);

/// The directory of the block at `start`; nothing if the file ends before the block does.
/// @throws InputError if the block contradicts itself or is compressed in an unknown way.
std::optional<FlirBlock> read_flir_block(const ByteFile& file, std::uint64_t start,
                                         std::size_t frame);

/// The camera's record of a block; nothing if there is none or it holds no calibration (all zero).
/// @throws InputError if the calibration is unusable.
std::optional<FlirCamera> read_flir_camera(const ByteFile& file, const FlirBlock& block,
                                           std::size_t frame);

/// @throws InputError that names file and frame.
[[noreturn]] void refuse_flir_frame(const ByteFile& file, std::size_t frame,
                                    const std::string& what);

}  // namespace meltproof::imaging

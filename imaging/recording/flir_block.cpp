// SPDX-License-Identifier: GPL-3.0-or-later
// A block begins with 64 bytes (FFF\0 or AFF\0; u32 version at 0x14, whose plausible reading tells
// the byte order; u32 place and number of directory entries at 0x18 and 0x1C). A directory entry
// has 32 bytes: u16 type, u16 subtype, then u32 place and length of the record at 0x0C and 0x10.
// The next block begins where the last record of a block ends; the magic itself also occurs inside
// pixels, so it is searched for only behind a block. Records have a byte order of their own, told
// by their first word, which is 2 in the files that were seen.
#include "imaging/recording/flir_block.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.hpp"

namespace meltproof::imaging {
namespace {

constexpr std::uint64_t block_header = 64, entry_size = 32;
// The camera's record up to the last constant of the calibration, to the clock and to the frame
// rate: older cameras write shorter ones.
constexpr std::uint64_t camera_constants = 0x310, camera_clock = 0x38A, camera_rate = 0x466;
// Rows that a raw record may hold behind its picture: some cameras add lines about themselves.
constexpr std::uint64_t most_extra_rows = 64;
constexpr std::uint16_t raw_record = 1, camera_record = 0x20;
// More pixels than this cannot come out of a byte: a damaged size is told before memory is asked
// for. DEFLATE gains a factor of 1032 at most; JPEG-LS codes a constant row in some 16 bits.
constexpr std::uint64_t png_pixels_per_byte = 1100, jpeg_ls_pixels_per_byte = 10000;

/// The byte order in which the 16-bit word at the beginning of a record is a small number; that of
/// the directory is tried first.
std::endian record_order(const ByteFile& file, std::size_t frame, const std::string& record,
                         std::endian directory) {
  constexpr unsigned small = 0x100;
  const auto other = directory == std::endian::little ? std::endian::big : std::endian::little;
  for (const auto order : {directory, other})
    if (number_at<std::uint16_t>(record, 0, order) < small) return order;
  refuse_flir_frame(file, frame, "has a record without a byte-order mark; the file is damaged.");
}

/// Fills size and coding from the raw record. The subtype is 1 or 2 for pixels as they are, big or
/// little endian, 3 for PNG and 4 for JPEG-LS; the first bytes of the pixels have the last word,
/// because some software leaves the subtype as it was when it compresses.
void read_raw_header(const ByteFile& file, std::size_t frame, FlirBlock& block) {
  if (block.raw.length < flir_raw_header)
    refuse_flir_frame(file, frame, "has no record with pixels; the file is damaged.");
  const std::string raw = file.bytes(block.raw.place, flir_raw_header);
  block.order = record_order(file, frame, raw, block.header_order);
  block.width = number_at<std::uint16_t>(raw, 2, block.order);
  block.height = number_at<std::uint16_t>(raw, 4, block.order);
  const std::uint64_t pixels = std::uint64_t{block.width} * block.height;
  const std::uint64_t stored = block.raw.length - flir_raw_header;
  const auto raw_pixels = [&] {
    const auto named = block.raw.subtype == 1 ? std::endian::big : std::endian::little;
    block.order_in_doubt = block.raw.subtype != 0 && named != block.order;
  };
  if (block.raw.subtype <= 2 && stored == 2 * pixels) return raw_pixels();
  const std::string mark =
      file.bytes(block.raw.place + flir_raw_header, std::min<std::uint64_t>(4, stored));
  if (mark == "\x89PNG")
    block.coding = FlirCoding::png;
  else if (mark == "\xFF\xD8\xFF\xF7")
    block.coding = FlirCoding::jpeg_ls;
  else if (block.raw.subtype > 2)
    refuse_flir_frame(
        file, frame,
        fmt::format("has pixels of the unknown kind {}, which are neither PNG nor JPEG-LS; export "
                    "the recording uncompressed or as a 16-bit TIFF stack.",
                    block.raw.subtype));
  else if (pixels > 0 && stored > 2 * pixels &&
           stored - 2 * pixels <= 2 * most_extra_rows * block.width)
    return raw_pixels();
  const std::uint64_t most =
      block.coding == FlirCoding::png ? png_pixels_per_byte : jpeg_ls_pixels_per_byte;
  if (block.coding == FlirCoding::raw || pixels > most * stored)
    refuse_flir_frame(
        file, frame,
        fmt::format("says {} x {} pixels, but its record has {} bytes; the file is damaged or of "
                    "an unknown kind.",
                    block.width, block.height, block.raw.length));
}

}  // namespace

void refuse_flir_frame(const ByteFile& file, std::size_t frame, const std::string& what) {
  throw InputError(fmt::format("{}: frame {} {}", file.path().string(), frame, what));
}

bool begins_flir_block(std::string_view bytes) {
  return bytes.starts_with(std::string_view("FFF\0", 4)) ||
         bytes.starts_with(std::string_view("AFF\0", 4));
}

std::optional<std::uint64_t> find_flir_block(const ByteFile& file, std::uint64_t from,
                                             const FlirBlock& like, std::size_t frame) {
  constexpr std::uint64_t portion = 1 << 20, magic = 4;
  for (std::uint64_t at = from; at < file.size() && file.size() - at >= block_header;
       at += portion) {
    const std::string bytes = file.bytes(at, std::min(portion + magic - 1, file.size() - at));
    for (std::size_t i = bytes.find(std::string_view("FF\0", 3)); i != std::string::npos;
         i = bytes.find(std::string_view("FF\0", 3), i + 1)) {
      if (i == 0 || !begins_flir_block(std::string_view(bytes).substr(i - 1))) continue;
      try {
        const auto block = read_flir_block(file, at + i - 1, frame);
        if (block && block->width == like.width && block->height == like.height) return at + i - 1;
      } catch (const InputError&) {  // four bytes that look like a beginning
      }
    }
  }
  return std::nullopt;
}

std::optional<FlirBlock> read_flir_block(const ByteFile& file, std::uint64_t start,
                                         std::size_t frame) {
  if (file.size() - start < block_header) return std::nullopt;
  const std::string head = file.bytes(start, block_header);
  auto order = std::endian::little;
  const auto u32 = [&](std::size_t at) {
    return std::uint64_t{number_at<std::uint32_t>(head, at, order)};
  };
  const auto plausible = [&] { return u32(0x14) >= 100 && u32(0x14) < 200; };
  if (!plausible()) order = std::endian::big;
  if (!plausible())
    refuse_flir_frame(file, frame, "has no plausible version in its header; the file is damaged.");
  const std::uint64_t directory = u32(0x18), entries = u32(0x1C);
  if (entries > 65536)
    refuse_flir_frame(file, frame,
                      fmt::format("has a directory of {} entries; the file is damaged.", entries));
  FlirBlock block;
  block.header_order = order;
  block.end = start + directory + entries * entry_size;
  if (block.end > file.size()) return std::nullopt;
  const std::string table = file.bytes(start + directory, entries * entry_size);
  for (std::uint64_t i = 0; i < entries; ++i) {
    const auto at = static_cast<std::size_t>(i * entry_size);
    const auto type = number_at<std::uint16_t>(table, at, order);
    const FlirRecord record{start + number_at<std::uint32_t>(table, at + 0x0C, order),
                            number_at<std::uint32_t>(table, at + 0x10, order),
                            number_at<std::uint16_t>(table, at + 2, order)};
    if (type == 0) continue;
    block.end = std::max(block.end, record.place + record.length);
    if (type == raw_record) block.raw = record;
    if (type == camera_record) block.camera = record;
  }
  if (block.end > file.size()) return std::nullopt;
  read_raw_header(file, frame, block);
  return block;
}

std::optional<FlirCamera> read_flir_camera(const ByteFile& file, const FlirBlock& block,
                                           std::size_t frame) {
  if (block.camera.length == 0) return std::nullopt;
  if (block.camera.length < camera_constants)
    refuse_flir_frame(file, frame,
                      fmt::format("has {} bytes of camera information, expected at least {}; the "
                                  "file is damaged or of an unknown kind.",
                                  block.camera.length, camera_constants));
  const std::string b = file.bytes(block.camera.place, std::min(block.camera.length, camera_rate));
  const auto order = record_order(file, frame, b, block.header_order);
  const auto f = [&](std::size_t at) {
    return static_cast<double>(number_at<float>(b, at, order));
  };
  FlirCamera camera;
  auto& c = camera.constants;
  c.emissivity = f(0x20);
  c.distance = f(0x24);
  c.reflected_temperature = f(0x28);
  c.atmospheric_temperature = f(0x2C);
  c.window_temperature = f(0x30);
  c.window_transmission = f(0x34);
  c.relative_humidity = f(0x3C) > 2 ? f(0x3C) / 100 : f(0x3C);  // some cameras store per cent
  c.planck_r1 = f(0x58);
  c.planck_b = f(0x5C);
  c.planck_f = f(0x60);
  c.alpha_1 = f(0x70);
  c.alpha_2 = f(0x74);
  c.beta_1 = f(0x78);
  c.beta_2 = f(0x7C);
  c.x = f(0x80);
  c.planck_o = number_at<std::int32_t>(b, 0x308, order);
  c.planck_r2 = f(0x30C);
  camera.saturated = f(0xA8);
  camera.under_range = f(0xAC);
  if (b.size() >= camera_clock + 2)
    camera.milliseconds = std::int64_t{number_at<std::uint32_t>(b, 0x384, order)} * 1000 +
                          (number_at<std::uint32_t>(b, 0x388, order) & 0xFFFF);
  if (b.size() >= camera_rate) camera.frame_rate = number_at<std::uint16_t>(b, 0x464, order);
  if (c.planck_r1 == 0 && c.planck_b == 0 && c.planck_r2 == 0) return std::nullopt;
  if (!(c.planck_r1 > 0 && c.planck_b > 0 && c.planck_r2 > 0 && c.emissivity > 0 &&
        c.window_transmission > 0))
    refuse_flir_frame(
        file, frame,
        fmt::format(
            "has no usable calibration (R1 {}, B {}, R2 {}, emissivity {}); the file is damaged.",
            c.planck_r1, c.planck_b, c.planck_r2, c.emissivity));
  return camera;
}

}  // namespace meltproof::imaging

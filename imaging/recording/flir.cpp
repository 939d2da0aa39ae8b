// SPDX-License-Identifier: GPL-3.0-or-later
// A file is a row of blocks. A block begins with 64 bytes (FFF\0 or AFF\0; u32 version at 0x14,
// whose plausible reading tells the byte order; u32 place and number of directory entries at 0x18
// and 0x1C). A directory entry has 32 bytes: u16 type, u16 subtype, then u32 place and length of
// the record at 0x0C and 0x10. The next block begins where the last record of a block ends; the
// magic itself also occurs inside pixels, so it is never searched for. Records have a byte order of
// their own, told by their first word, which is 2.
#include "imaging/recording/flir.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "base/error.hpp"
#include "imaging/recording/bytes.hpp"
#include "imaging/recording/flir_temperature.hpp"

namespace meltproof::imaging {
namespace {

constexpr std::uint64_t block_header = 64, entry_size = 32, raw_header = 32, camera_size = 0x466;
constexpr std::uint16_t raw_record = 1, camera_record = 0x20;

struct Record {
  std::uint64_t place = 0, length = 0;
  std::uint16_t subtype = 0;
};

struct Block {
  Record raw, camera;
  std::uint64_t end = 0;
  std::size_t width = 0, height = 0;
  std::endian order = std::endian::little;  // of the pixels
};

bool has_magic(std::string_view bytes) {
  return bytes.starts_with(std::string_view("FFF\0", 4)) ||
         bytes.starts_with(std::string_view("AFF\0", 4));
}

[[noreturn]] void refuse(const ByteFile& file, std::size_t frame, const std::string& what) {
  throw InputError(fmt::format("{}: frame {} {}", file.path().string(), frame, what));
}

/// The byte order in which the 16-bit word at the beginning of a record is 2.
std::endian record_order(const ByteFile& file, std::size_t frame, const std::string& record) {
  for (const auto order : {std::endian::little, std::endian::big})
    if (number_at<std::uint16_t>(record, 0, order) == 2) return order;
  refuse(file, frame, "has a record without a byte-order mark; the file is damaged.");
}

/// Reads the directory of the block at `start`; nothing if the file ends before the block does.
std::optional<Block> read_block(const ByteFile& file, std::uint64_t start, std::size_t frame) {
  if (file.size() - start < block_header) return std::nullopt;
  const std::string head = file.bytes(start, block_header);
  auto order = std::endian::little;
  const auto u32 = [&](std::size_t at) {
    return std::uint64_t{number_at<std::uint32_t>(head, at, order)};
  };
  const auto plausible = [&] { return u32(0x14) >= 100 && u32(0x14) < 200; };
  if (!plausible()) order = std::endian::big;
  if (!plausible())
    refuse(file, frame, "has no plausible version in its header; the file is damaged.");
  const std::uint64_t directory = u32(0x18), entries = u32(0x1C);
  if (entries > 65536)
    refuse(file, frame,
           fmt::format("has a directory of {} entries; the file is damaged.", entries));
  Block block;
  block.end = start + directory + entries * entry_size;
  if (block.end > file.size()) return std::nullopt;
  const std::string table = file.bytes(start + directory, entries * entry_size);
  for (std::uint64_t i = 0; i < entries; ++i) {
    const auto at = static_cast<std::size_t>(i * entry_size);
    const auto type = number_at<std::uint16_t>(table, at, order);
    const Record record{start + number_at<std::uint32_t>(table, at + 0x0C, order),
                        number_at<std::uint32_t>(table, at + 0x10, order),
                        number_at<std::uint16_t>(table, at + 2, order)};
    if (type == 0) continue;
    block.end = std::max(block.end, record.place + record.length);
    if (type == raw_record) block.raw = record;
    if (type == camera_record) block.camera = record;
  }
  if (block.end > file.size()) return std::nullopt;

  if (block.raw.length < raw_header)
    refuse(file, frame, "has no record with pixels; the file is damaged.");
  if (block.raw.subtype > 2)
    refuse(file, frame,
           fmt::format(
               "is compressed ({}); that cannot be read yet: export the recording uncompressed "
               "or as a 16-bit TIFF stack.",
               block.raw.subtype == 3 ? "PNG" : "JPEG-LS or unknown"));
  const std::string raw = file.bytes(block.raw.place, raw_header);
  block.order = record_order(file, frame, raw);
  block.width = number_at<std::uint16_t>(raw, 2, block.order);
  block.height = number_at<std::uint16_t>(raw, 4, block.order);
  if (block.raw.length != raw_header + 2 * block.width * block.height)
    refuse(file, frame,
           fmt::format(
               "says {} x {} pixels, but its record has {} bytes; the file is damaged or of an "
               "unknown kind.",
               block.width, block.height, block.raw.length));
  return block;
}

struct Camera {
  FlirConstants constants;
  std::int64_t milliseconds = 0;  // since 1970, as an integer: a double would round the differences
  double frame_rate = 0;          // Hz
  double saturated = 0, under_range = 0;  // K
};

Camera read_camera(const ByteFile& file, const Block& block, std::size_t frame) {
  if (block.camera.length < camera_size)
    refuse(file, frame,
           "has no camera information, so its counts have no temperature; the file is damaged.");
  const std::string b = file.bytes(block.camera.place, camera_size);
  const auto order = record_order(file, frame, b);
  const auto f = [&](std::size_t at) {
    return static_cast<double>(number_at<float>(b, at, order));
  };
  Camera camera;
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
  camera.milliseconds = std::int64_t{number_at<std::uint32_t>(b, 0x384, order)} * 1000 +
                        (number_at<std::uint32_t>(b, 0x388, order) & 0xFFFF);
  camera.frame_rate = number_at<std::uint16_t>(b, 0x464, order);
  if (!(c.planck_r1 > 0 && c.planck_b > 0 && c.planck_r2 > 0 && c.emissivity > 0 &&
        c.window_transmission > 0))
    refuse(
        file, frame,
        fmt::format(
            "has no usable calibration (R1 {}, B {}, R2 {}, emissivity {}); the file is damaged.",
            c.planck_r1, c.planck_b, c.planck_r2, c.emissivity));
  return camera;
}

}  // namespace

bool is_flir(std::string_view first_bytes) { return has_magic(first_bytes); }

Recording open_flir(const std::filesystem::path& path) {
  const ByteFile file(path);
  RecordingHeader header;
  header.path = path;
  std::vector<Block> blocks;
  std::uint64_t at = 0;
  while (at < file.size()) {
    const auto rest = file.bytes(at, std::min<std::uint64_t>(4, file.size() - at));
    if (!has_magic(rest) && !(rest.size() < 4 && std::string_view("FFF").starts_with(rest))) {
      header.notes.push_back(
          fmt::format("{} bytes behind the last frame belong to no frame and were not read.",
                      file.size() - at));
      break;
    }
    const auto block = read_block(file, at, blocks.size());
    if (!block) {  // the format announces no number of frames: one was begun, more may have
                   // followed
      header.frames_lost = 1;
      break;
    }
    if (!blocks.empty() && (block->width != blocks[0].width || block->height != blocks[0].height))
      refuse(file, blocks.size(), "has another size than the first; split the recording by size.");
    blocks.push_back(*block);
    at = block->end;
  }
  header.frames = blocks.size();
  if (blocks.empty()) return {header, nullptr};

  header.width = blocks[0].width;
  header.height = blocks[0].height;
  const Camera first = read_camera(file, blocks[0], 0);
  const auto& c = first.constants;
  header.quantity = SignalQuantity::temperature;
  header.unit = std::string("K");  // a bare "K" meets a false warning of GCC 12
  header.frame_rate = first.frame_rate;
  if (first.saturated > 0) header.saturation = first.saturated;
  header.under_range = first.under_range;
  header.calibration = {{"planck_r1", c.planck_r1},
                        {"planck_b_K", c.planck_b},
                        {"planck_f", c.planck_f},
                        {"planck_o", c.planck_o},
                        {"planck_r2", c.planck_r2},
                        {"emissivity", c.emissivity},
                        {"distance_m", c.distance},
                        {"reflected_temperature_K", c.reflected_temperature},
                        {"atmospheric_temperature_K", c.atmospheric_temperature},
                        {"window_temperature_K", c.window_temperature},
                        {"window_transmission", c.window_transmission},
                        {"relative_humidity", c.relative_humidity}};
  if (blocks.size() > 1 && header.frame_rate > 0) {
    const auto last = read_camera(file, blocks.back(), blocks.size() - 1).milliseconds;
    const double elapsed = static_cast<double>(last - first.milliseconds) / 1000;
    const double period = elapsed / static_cast<double>(blocks.size() - 1);
    if (std::abs(period * header.frame_rate - 1) > 0.1)
      header.notes.push_back(fmt::format(
          "The camera ran at {} Hz, but the stored frames are {:.3f} s apart; their times are the "
          "camera's clock.",
          header.frame_rate, period));
  }
  return {header, [file, blocks, start = first.milliseconds](std::size_t index, Frame& frame) {
            const auto& block = blocks[index];
            const Camera camera = read_camera(file, block, index);
            const FlirTemperature temperature(camera.constants);
            frame.time = static_cast<double>(camera.milliseconds - start) / 1000;
            frame.counts.resize(frame.values.size());
            widen(file.bytes(block.raw.place + raw_header, 2 * frame.counts.size()), block.order,
                  frame.counts);
            std::transform(frame.counts.begin(), frame.counts.end(), frame.values.begin(),
                           [&](float counts) {
                             return static_cast<float>(temperature(static_cast<double>(counts)));
                           });
          }};
}

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/flir.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "base/error.hpp"
#include "imaging/recording/flir_block.hpp"
#include "imaging/recording/flir_pixels.hpp"

namespace meltproof::imaging {
namespace {

/// The blocks of a file in their order; what is cut off or foreign is noted in the header.
std::vector<FlirBlock> read_blocks(const ByteFile& file, RecordingHeader& header) {
  std::vector<FlirBlock> blocks;
  std::uint64_t at = 0, between = 0;
  while (at < file.size()) {
    const auto rest = file.bytes(at, std::min<std::uint64_t>(4, file.size() - at));
    if (!begins_flir_block(rest) &&
        !(rest.size() < 4 && std::string_view("FFF").starts_with(rest))) {
      const auto next =
          blocks.empty() ? std::nullopt : find_flir_block(file, at, blocks.front(), blocks.size());
      if (!next) {
        header.notes.push_back(
            fmt::format("{} bytes behind the last frame belong to no frame and were not read.",
                        file.size() - at));
        break;
      }
      between += *next - at;
      at = *next;
    }
    const auto block = read_flir_block(file, at, blocks.size());
    if (!block) {
      header.frames_lost = 1;  // no number of frames is announced: more may have followed
      break;
    }
    if (!blocks.empty() && (block->width != blocks[0].width || block->height != blocks[0].height))
      refuse_flir_frame(file, blocks.size(),
                        "has another size than the first; split the recording by size.");
    blocks.push_back(*block);
    at = block->end;
  }
  if (between > 0)
    header.notes.push_back(
        fmt::format("{} bytes between the frames belong to no frame and were left out.", between));
  return blocks;
}

void describe_camera(const FlirCamera& camera, RecordingHeader& header) {
  const auto& c = camera.constants;
  header.quantity = SignalQuantity::temperature;
  header.unit = std::string("K");  // a bare "K" meets a false warning of GCC 12
  header.frame_rate = camera.frame_rate;
  if (camera.saturated > 0) header.saturation = camera.saturated;
  header.under_range = camera.under_range;
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
}

/// A sentence where the clock in the frames contradicts the frame rate.
void compare_clocks(const FlirCamera& first, const std::optional<FlirCamera>& last,
                    RecordingHeader& header) {
  if (!last || header.frames < 2 || !(header.frame_rate > 0)) return;
  if (!last->milliseconds || !first.milliseconds) return;
  const double elapsed = static_cast<double>(*last->milliseconds - *first.milliseconds) / 1000;
  const double period = elapsed / static_cast<double>(header.frames - 1);
  if (std::abs(period * header.frame_rate - 1) > 0.1)
    header.notes.push_back(fmt::format(
        "The camera ran at {} Hz, but the stored frames are {:.3f} s apart; their times are the "
        "camera's clock.",
        header.frame_rate, period));
}

/// Whether the bytes of the samples are the wrong way round, judged by the first frame for which
/// the file does not tell, and a sentence about it.
bool judge_byte_order(const ByteFile& file, const std::vector<FlirBlock>& blocks,
                      RecordingHeader& header) {
  const auto doubted = std::find_if(blocks.begin(), blocks.end(), [](const FlirBlock& block) {
    return block.coding != FlirCoding::raw || block.order_in_doubt;
  });
  if (doubted == blocks.end()) return false;
  const auto frame = static_cast<std::size_t>(doubted - blocks.begin());
  bool exchanged = false;
  try {
    exchanged = flir_bytes_are_exchanged(file, *doubted, frame);
  } catch (const InputError&) {
    if (doubted->coding != FlirCoding::jpeg_ls) throw;
    return false;  // said when that frame is read; the others may be whole
  }
  const char* kind = doubted->coding == FlirCoding::png       ? "as PNG "
                     : doubted->coding == FlirCoding::jpeg_ls ? "as JPEG-LS "
                                                              : "";
  if (exchanged || doubted->coding != FlirCoding::jpeg_ls)
    header.notes.push_back(
        fmt::format("The frames are stored {}with {} bytes, judged by which order is smoother; the "
                    "file {}.",
                    kind, exchanged ? "exchanged" : "regular",
                    doubted->coding == FlirCoding::raw ? "contradicts itself" : "does not say"));
  return exchanged;
}

}  // namespace

bool is_flir(std::string_view first_bytes) { return begins_flir_block(first_bytes); }

Recording open_flir(const std::filesystem::path& path) { return open_flir_blocks(ByteFile(path)); }

Recording open_flir_blocks(const ByteFile& file) {
  RecordingHeader header;
  header.path = file.path();
  const auto blocks = read_blocks(file, header);
  header.frames = blocks.size();
  if (blocks.empty()) return {header, nullptr};
  header.width = blocks[0].width;
  header.height = blocks[0].height;

  const auto first = read_flir_camera(file, blocks[0], 0);
  if (first) {
    describe_camera(*first, header);
    compare_clocks(*first, read_flir_camera(file, blocks.back(), blocks.size() - 1), header);
  } else {
    header.saturation = 65535;
    header.under_range = 0;
    header.notes.push_back(
        "The camera stored no calibration, so the frames are bare counts without a temperature.");
  }
  check_frame_size(header);
  const bool exchanged = judge_byte_order(file, blocks, header);
  return {header, [file, blocks, exchanged, first](std::size_t index, Frame& frame) {
            const auto& block = blocks[index];
            const bool turn =
                exchanged && (block.coding != FlirCoding::raw || block.order_in_doubt);
            if (!first) {
              read_flir_counts(file, block, turn, index, frame.values);
              return;
            }
            // Some sequences tell the camera only in their first frame.
            const auto own = read_flir_camera(file, block, index);
            const FlirTemperature temperature((own ? *own : *first).constants);
            if (own && own->milliseconds && first->milliseconds)
              frame.time = static_cast<double>(*own->milliseconds - *first->milliseconds) / 1000;
            frame.counts.resize(frame.values.size());
            read_flir_counts(file, block, turn, index, frame.counts);
            std::transform(frame.counts.begin(), frame.counts.end(), frame.values.begin(),
                           [&](float counts) {
                             return static_cast<float>(temperature(static_cast<double>(counts)));
                           });
          }};
}

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/flir.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "imaging/recording/flir_block.hpp"
#include "imaging/recording/flir_pixels.hpp"

namespace meltproof::imaging {
namespace {

/// The blocks of a file in their order; what is cut off or foreign is noted in the header.
std::vector<FlirBlock> read_blocks(const ByteFile& file, RecordingHeader& header) {
  std::vector<FlirBlock> blocks;
  std::uint64_t at = 0;
  while (at < file.size()) {
    const auto rest = file.bytes(at, std::min<std::uint64_t>(4, file.size() - at));
    if (!begins_flir_block(rest) &&
        !(rest.size() < 4 && std::string_view("FFF").starts_with(rest))) {
      header.notes.push_back(
          fmt::format("{} bytes behind the last frame belong to no frame and were not read.",
                      file.size() - at));
      break;
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
  const double elapsed = static_cast<double>(last->milliseconds - first.milliseconds) / 1000;
  const double period = elapsed / static_cast<double>(header.frames - 1);
  if (std::abs(period * header.frame_rate - 1) > 0.1)
    header.notes.push_back(fmt::format(
        "The camera ran at {} Hz, but the stored frames are {:.3f} s apart; their times are the "
        "camera's clock.",
        header.frame_rate, period));
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
  const auto png = std::find_if(blocks.begin(), blocks.end(), [](const FlirBlock& block) {
    return block.coding == FlirCoding::png;
  });
  bool exchanged = false;
  check_frame_size(header);
  if (png != blocks.end()) {
    exchanged = flir_png_is_exchanged(file, *png, static_cast<std::size_t>(png - blocks.begin()));
    header.notes.push_back(
        fmt::format("The frames are stored as PNG with {} bytes, judged by which order is "
                    "smoother; the file does not say.",
                    exchanged ? "exchanged" : "regular"));
  }
  return {header, [file, blocks, exchanged, first](std::size_t index, Frame& frame) {
            const auto& block = blocks[index];
            if (!first) {
              read_flir_counts(file, block, exchanged, index, frame.values);
              return;
            }
            const auto camera = read_flir_camera(file, block, index);
            if (!camera)
              refuse_flir_frame(file, index,
                                "has no calibration, but the first frame has one; the file is "
                                "damaged.");
            const FlirTemperature temperature(camera->constants);
            frame.time = static_cast<double>(camera->milliseconds - first->milliseconds) / 1000;
            frame.counts.resize(frame.values.size());
            read_flir_counts(file, block, exchanged, index, frame.counts);
            std::transform(frame.counts.begin(), frame.counts.end(), frame.values.begin(),
                           [&](float counts) {
                             return static_cast<float>(temperature(static_cast<double>(counts)));
                           });
          }};
}

}  // namespace meltproof::imaging

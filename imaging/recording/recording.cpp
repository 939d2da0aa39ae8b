// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/recording.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"

namespace meltproof::imaging {

std::string quantity_name(SignalQuantity quantity) {
  switch (quantity) {
    case SignalQuantity::counts:
      return "counts";
    case SignalQuantity::temperature:
      return "temperature";
    case SignalQuantity::radiance:
      return "radiance";
  }
  return "";
}

SignalQuantity parse_signal_quantity(const std::string& name) {
  for (const auto quantity :
       {SignalQuantity::counts, SignalQuantity::temperature, SignalQuantity::radiance})
    if (quantity_name(quantity) == name) return quantity;
  throw InputError(fmt::format(
      "The quantity of a recording is \"{}\"; expected counts, temperature or radiance.", name));
}

void check_frame_size(const RecordingHeader& header) {
  if (header.width == 0 || header.height == 0)
    throw InputError(fmt::format("{}: the frames have no pixels ({} x {}).", header.path.string(),
                                 header.width, header.height));
  constexpr std::size_t most = 100'000'000;  // pixels: more than any camera has
  if (header.width > most || header.height > most / header.width)
    throw InputError(fmt::format(
        "{}: the frames are said to have {} x {} pixels, more than any camera has; the file is "
        "damaged.",
        header.path.string(), header.width, header.height));
}

Recording::Recording(RecordingHeader header, ReadFrame read)
    : header_(std::move(header)), read_(std::move(read)) {
  if (header_.frames == 0)
    throw InputError(
        fmt::format("{}: the file ends before its first frame is whole; copy it again from its "
                    "source or record "
                    "anew.",
                    header_.path.string()));
  check_frame_size(header_);
}

void Recording::read(std::size_t index, Frame& frame) const {
  if (index >= header_.frames)
    throw InputError(
        fmt::format("{}: frame {} was asked for, but the recording has {} frames, counted from 0.",
                    header_.path.string(), index, header_.frames));
  const std::size_t pixels = header_.width * header_.height;
  frame.index = index;
  frame.time = header_.frame_rate > 0 ? static_cast<double>(index) / header_.frame_rate : 0;
  frame.values.resize(pixels);
  frame.counts.clear();
  frame.status.resize(pixels);
  read_(index, frame);
  const auto high = static_cast<float>(header_.saturation);
  const auto low = static_cast<float>(header_.under_range);
  std::transform(frame.values.begin(), frame.values.end(), frame.status.begin(), [&](float value) {
    if (!std::isfinite(value)) return PixelStatus::dead;
    if (value >= high) return PixelStatus::saturated;
    return value <= low ? PixelStatus::under_range : PixelStatus::good;
  });
}

Frame Recording::frame(std::size_t index) const {
  Frame frame;
  read(index, frame);
  return frame;
}

Recording with_linear_temperature(Recording recording, double kelvin_per_count, double offset) {
  auto header = recording.header();
  if (header.quantity != SignalQuantity::counts)
    throw InputError(
        fmt::format("{}: a scale of kelvin per count was given, but the file holds {} already; "
                    "leave the scale out.",
                    header.path.string(), quantity_name(header.quantity)));
  header.quantity = SignalQuantity::temperature;
  header.unit = std::string("K");  // a bare "K" meets a false warning of GCC 12
  header.radiometry.reset();
  header.calibration["kelvin_per_count"] = kelvin_per_count;
  header.calibration["offset_K"] = offset;
  header.saturation = offset + kelvin_per_count * header.saturation;
  header.under_range = offset + kelvin_per_count * header.under_range;
  return {
      header,
      [source = std::move(recording), kelvin_per_count, offset](std::size_t index, Frame& frame) {
        Frame stored = source.frame(index);
        frame.time = stored.time;
        std::transform(
            stored.values.begin(), stored.values.end(), frame.values.begin(), [&](float counts) {
              return static_cast<float>(offset + kelvin_per_count * static_cast<double>(counts));
            });
        frame.counts = std::move(stored.values);
      }};
}

}  // namespace meltproof::imaging

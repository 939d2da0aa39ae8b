// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/hdf5.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include "base/artifact.hpp"
#include "base/error.hpp"
#include "imaging/recording/hdf5_array.hpp"

namespace meltproof::imaging {

namespace {

Recording open_own(const std::filesystem::path& path);

}  // namespace

bool is_hdf5(std::string_view first_bytes) { return first_bytes.starts_with("\x89HDF\r\n\x1a\n"); }

Recording open_hdf5(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string kind = ArtifactReader(path).attribute("kind");
  if (kind.starts_with("meltproof") && options.dataset.empty()) return open_own(path);
  return open_hdf5_array(path, options, "fhw", false);
}

namespace {

Recording open_own(const std::filesystem::path& path) {
  const auto file = std::make_shared<ArtifactReader>(path, "meltproof recording");
  const auto shape = file->shape("frames");
  if (shape.size() != 3)
    throw InputError(path.string() + ": the data set frames has " + std::to_string(shape.size()) +
                     " dimensions; expected 3 (frame, height, width).");
  const auto optional = [&](const std::string& name, double otherwise) {
    return file->has(name) ? file->scalar(name) : otherwise;
  };

  RecordingHeader header;
  header.path = path;
  header.frames = shape[0];
  header.height = shape[1];
  header.width = shape[2];
  header.quantity = parse_signal_quantity(file->attribute("quantity"));
  header.unit = file->units("frames");
  header.frame_rate = optional("frame_rate", 0);
  header.integration_time = optional("integration_time", 0);
  header.pixel_size = optional("pixel_size", 0);
  header.saturation = optional("saturation_count", header.saturation);
  if (header.quantity == SignalQuantity::counts) header.under_range = 0;
  header.synthetic = file->attribute("synthetic");
  if (file->has("radiometry")) {
    Radiometry r;
    r.band_lower = file->scalar("radiometry/band_lower");
    r.band_upper = file->scalar("radiometry/band_upper");
    r.transmission = file->scalar("radiometry/transmission");
    r.emissivity = file->scalar("radiometry/emissivity");
    r.gain = file->scalar("radiometry/gain");
    r.dark = file->scalar("radiometry/dark");
    r.ambient_temperature = file->scalar("radiometry/ambient_temperature");
    r.window_temperature = optional("radiometry/window_temperature", 0);
    r.window_emission = optional("radiometry/window_emission", 0) != 0;
    r.integration_time = header.integration_time;
    header.radiometry = r;
    if (file->has("radiometry/emissivity_liquid"))
      header.emissivity_liquid = file->scalar("radiometry/emissivity_liquid");
  }
  std::vector<double> times;
  if (file->has("time")) times = file->read<double>("time").values;
  if (!times.empty() && times.size() != header.frames)
    throw InputError(path.string() + ": there are " + std::to_string(times.size()) + " times for " +
                     std::to_string(header.frames) + " frames; the file is damaged.");

  return {header, [file, times](std::size_t index, Frame& frame) {
            const auto values = file->read_slab<float>("frames", index, 1);
            std::copy(values.begin(), values.end(), frame.values.begin());
            if (!times.empty()) frame.time = times[index] - times.front();
          }};
}

}  // namespace

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/hdf5.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/artifact.hpp"
#include "base/error.hpp"
#include "imaging/recording/guarded.hpp"
#include "imaging/recording/hdf5_array.hpp"

namespace meltproof::imaging {

namespace {

Recording open_own(const std::filesystem::path& path);

}  // namespace

bool is_hdf5(std::string_view first_bytes) { return first_bytes.starts_with("\x89HDF\r\n\x1a\n"); }

namespace {

Recording open_either(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string kind = ArtifactReader(path).attribute("kind");
  if (kind.starts_with("meltproof") && options.dataset.empty()) return open_own(path);
  return open_hdf5_array(path, options, "fhw", false);
}

}  // namespace

Recording open_hdf5(const std::filesystem::path& path, const ReadOptions& options) {
  try_in_child(path, "HDF5", [&] {
    const Recording recording = open_either(path, options);
    if (recording.header().frames > 0) recording.frame(0);
  });
  return open_either(path, options);
}

namespace {

/// A number that may be missing. Its shape is looked at first: a damaged one asks for any memory.
double number(const ArtifactReader& file, const std::string& name,
              std::optional<double> otherwise = std::nullopt) {
  if (otherwise && !file.has(name)) return *otherwise;
  if (!file.shape(name).empty())
    throw InputError(file.path().string() + ": " + name +
                     " is a list, expected one number; the file is damaged.");
  return file.scalar(name);
}

std::vector<double> read_times(const ArtifactReader& file, std::size_t frames, std::size_t lost) {
  if (!file.has("time")) return {};
  const auto shape = file.shape("time");
  if (shape.size() != 1 || shape[0] != frames + lost)
    throw InputError(file.path().string() + ": there are " +
                     std::to_string(shape.empty() ? 1 : shape[0]) + " times for " +
                     std::to_string(frames + lost) + " frames; the file is damaged.");
  return file.read<double>("time").values;
}

Recording open_own(const std::filesystem::path& path) {
  const auto file = std::make_shared<ArtifactReader>(path, "meltproof recording");
  const auto optional = [&](const std::string& name, double otherwise) {
    return number(*file, name, otherwise);
  };
  // The array alone, with every check that a foreign one meets; the artifact says what it means.
  const Recording array = open_hdf5_array(path, {.dataset = "frames"}, "fhw", false);
  RecordingHeader header = array.header();
  header.notes.clear();
  header.quantity = parse_signal_quantity(file->attribute("quantity"));
  if (header.quantity != array.header().quantity) header.unit = file->units("frames");
  header.frame_rate = optional("frame_rate", 0);
  header.integration_time = optional("integration_time", 0);
  header.pixel_size = optional("pixel_size", 0);
  header.point_spread = optional("optics/point_spread", 0);
  header.saturation = optional("saturation_count", header.saturation);
  if (header.quantity == SignalQuantity::counts) header.under_range = 0;
  header.synthetic = file->attribute("synthetic");
  if (file->has("radiometry")) {
    Radiometry r;
    r.band_lower = number(*file, "radiometry/band_lower");
    r.band_upper = number(*file, "radiometry/band_upper");
    r.transmission = number(*file, "radiometry/transmission");
    r.emissivity = number(*file, "radiometry/emissivity");
    r.gain = number(*file, "radiometry/gain");
    r.dark = number(*file, "radiometry/dark");
    r.ambient_temperature = number(*file, "radiometry/ambient_temperature");
    r.window_temperature = optional("radiometry/window_temperature", 0);
    r.window_emission = optional("radiometry/window_emission", 0) != 0;
    r.integration_time = header.integration_time;
    header.radiometry = r;
    if (file->has("radiometry/emissivity_liquid"))
      header.emissivity_liquid = number(*file, "radiometry/emissivity_liquid");
  }
  const auto times = read_times(*file, header.frames, header.frames_lost);
  return {header, [array, times](std::size_t index, Frame& frame) {
            array.read(index, frame);
            frame.time = times.empty() ? frame.time : times[index] - times.front();
          }};
}

}  // namespace

}  // namespace meltproof::imaging

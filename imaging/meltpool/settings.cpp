// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/settings.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/atomic_file.hpp"
#include "base/error.hpp"

namespace meltproof::imaging {

Input declare(Settings& s) {
  InputTable root("thermography", "How a recording of a melt pool is read and measured.");
  root.quantity(
          s.level,
          {.name = "level",
           .unit = "1",
           .about = "signal in counts at which the pool ends; replaces the reference temperature"})
      .quantity(
          s.reference_temperature,
          {.name = "reference_temperature",
           .unit = "K",
           .about = "temperature at which the pool ends, normally the liquidus of the alloy; "
                    "without it 1683 K, the "
                    "liquidus of 316L, where the recording holds temperatures or a radiometry",
           .minimum = 200,
           .maximum = 5000})
      .quantity(s.emissivity, {.name = "emissivity",
                               .unit = "1",
                               .about = "emissivity of solid metal in the camera's band",
                               .minimum = 0.01,
                               .maximum = 1})
      .quantity(s.emissivity_liquid, {.name = "emissivity_liquid",
                                      .unit = "1",
                                      .about = "emissivity of liquid metal in the camera's band, "
                                               "where it is less than that of solid metal",
                                      .minimum = 0.01,
                                      .maximum = 1})
      .quantity(s.transmission,
                {.name = "transmission",
                 .unit = "1",
                 .about = "transmission of all windows together in the camera's band",
                 .minimum = 1e-4,
                 .maximum = 1})
      .quantity(s.frame_rate, {.name = "frame_rate",
                               .unit = "Hz",
                               .about = "frames per second, for files that hold none",
                               .minimum = 1e-6,
                               .maximum = 1e9})
      .quantity(
          s.kelvin_per_count,
          {.name = "kelvin_per_count",
           .unit = "K",
           .about = "temperature of one count, for exports with a linear scale such as 0.04 K",
           .minimum = 1e-6,
           .maximum = 1e3})
      .quantity(s.zero_count_temperature, {.name = "zero_count_temperature",
                                           .unit = "K",
                                           .about = "temperature of count 0 of that scale"})
      .quantity(s.scan_speed, {.name = "scan_speed",
                               .unit = "m s-1",
                               .about = "speed of the beam, to check the speed that is measured",
                               .minimum = 1e-9,
                               .maximum = 1e3})
      .text(s.scan_direction, {.name = "scan_direction",
                               .about = "where the beam goes in the image; y points downwards",
                               .choices = {"+x", "-x", "+y", "-y"}})
      .file(s.calibration,
            {.name = "calibration",
             .about =
                 "calibration.json of meltproof-calibrate, for lengths in um instead of pixels"});
  return Input(std::move(root));
}

PixelSize read_pixel_size(const std::filesystem::path& calibration) {
  const auto json = nlohmann::json::parse(read_file(calibration), nullptr, false);
  if (!json.is_object())
    throw InputError(fmt::format(
        "{} is no JSON object; give the calibration.json that meltproof-calibrate wrote.",
        calibration.string()));
  const auto size = [&](const char* key) {
    const bool usable = json.contains(key) && json[key].is_number() &&
                        json[key].get<double>() > 0 && std::isfinite(json[key].get<double>());
    if (!usable)
      throw InputError(fmt::format(
          "{}: the key {} is missing or is no positive number; give the calibration.json that "
          "meltproof-calibrate wrote.",
          calibration.string(), key));
    return json[key].get<double>() * 1e-6;
  };
  const auto uncertainty = [&](const char* key) {
    return json.contains(key) && json[key].is_number() ? json[key].get<double>() * 1e-6 : 0.0;
  };
  return {size("pixel_size_x_um"), size("pixel_size_y_um"), uncertainty("u_pixel_size_x_um"),
          uncertainty("u_pixel_size_y_um")};
}

Recording apply(const Settings& settings, Recording recording) {
  if (settings.kelvin_per_count)
    recording = with_linear_temperature(std::move(recording), *settings.kelvin_per_count,
                                        settings.zero_count_temperature);
  auto& header = recording.header();
  if (settings.frame_rate) {
    if (header.frame_rate > 0 && std::abs(header.frame_rate / *settings.frame_rate - 1) > 1e-3)
      throw InputError(fmt::format(
          "{}: a frame rate of {:.6g} Hz was given, but the file says {:.6g} Hz; leave it out.",
          header.path.string(), *settings.frame_rate, header.frame_rate));
    header.frame_rate = *settings.frame_rate;
  }
  return recording;
}

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// What the settings make of a recording and of a calibration file.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "imaging/meltpool/settings.hpp"
#include "imaging/radiometry/spectrum.hpp"
#include "imaging/radiometry/uniformity.hpp"
#include "imaging/recording/formats.hpp"

namespace meltproof::imaging {

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

PointSpread point_spread_of(const Settings& settings, const RecordingHeader& header) {
  PointSpread found{settings.budget.point_spread, settings.budget.u_point_spread, "default"};
  constexpr double u_of_file = 0.02;
  if (header.point_spread > 0) found = {header.point_spread, u_of_file, "file"};
  if (!settings.calibration.empty()) {
    const auto json = nlohmann::json::parse(read_file(settings.calibration), nullptr, false);
    std::vector<double> sigmas;
    double variance = 0;
    const auto images = json.is_object() && json.contains("images") ? json["images"] : json;
    for (const auto& image : images) {
      if (!image.is_object() || !image.contains("edge_blur_px") ||
          !image["edge_blur_px"].is_number())
        continue;
      const double blur = image["edge_blur_px"].get<double>();
      // Of a calibration made before its uncertainty was written.
      const double u = image.contains("u_edge_blur_px") && image["u_edge_blur_px"].is_number()
                           ? image["u_edge_blur_px"].get<double>()
                           : 0.03;
      const double optics = blur * blur - 1.0 / 12;
      if (!(optics > 0.01)) continue;
      sigmas.push_back(std::sqrt(optics));
      variance += u * u * blur * blur / optics;
    }
    if (!sigmas.empty()) {
      const auto [low, high] = std::minmax_element(sigmas.begin(), sigmas.end());
      double mean = 0;
      const auto n = static_cast<double>(sigmas.size());
      for (const double s : sigmas) mean += s / n;
      // Edges fitted in synthetic scales of 0.8 px come out within 0.01 px of it.
      constexpr double least = 0.01;
      found = {mean, std::max({std::sqrt(variance) / n, 0.5 * (*high - *low), least}),
               "calibration"};
    }
  }
  if (settings.point_spread) {
    found.sigma = *settings.point_spread;
    found.u = settings.budget.u_point_spread;
    found.source = "given";
  }
  if (settings.u_point_spread) found.u = *settings.u_point_spread;
  return found;
}

namespace {

/// Mean of up to 200 frames of a uniform reference.
/// @throws InputError if its frames are not of the recording's size.
std::vector<double> mean_frame(const std::filesystem::path& path, const RecordingHeader& of) {
  const Recording reference = open_recording(path);
  const RecordingHeader& h = reference.header();
  if (h.width != of.width || h.height != of.height)
    throw InputError(fmt::format(
        "{}: the reference has {} x {} pixels, the recording {} x {} ({}); record the uniform "
        "references in the same window of the camera.",
        path.string(), h.width, h.height, of.width, of.height, of.path.string()));
  const std::size_t n = std::min<std::size_t>(reference.header().frames, 200);
  std::vector<double> mean(reference.header().width * reference.header().height, 0);
  for (std::size_t k = 0; k < n; ++k) {
    const Frame frame = reference.frame(k);
    for (std::size_t i = 0; i < mean.size(); ++i)
      mean[i] += static_cast<double>(frame.values[i]) / static_cast<double>(n);
  }
  return mean;
}

Recording made_uniform(const Settings& settings, Recording recording) {
  if (settings.uniform_cold.empty() || settings.uniform_hot.empty())
    throw InputError("uniform_cold and uniform_hot belong together: give both or neither.");
  auto header = recording.header();
  if (header.quantity != SignalQuantity::counts)
    throw InputError(
        fmt::format("{}: pixels can be made uniform in counts only, but the file "
                    "holds {}; leave uniform_cold and uniform_hot out.",
                    header.path.string(), quantity_name(header.quantity)));
  const std::vector<double> cold = mean_frame(settings.uniform_cold, header),
                            hot = mean_frame(settings.uniform_hot, header);
  const Uniformity uniformity = [&] {
    try {
      return two_point(cold, hot);
    } catch (const InputError& problem) {
      throw InputError(fmt::format("uniform_cold = {}, uniform_hot = {}: {}",
                                   settings.uniform_cold.string(), settings.uniform_hot.string(),
                                   problem.what()));
    }
  }();
  header.notes.push_back(
      fmt::format("Offsets and gains of the pixels are corrected by two references: gains differed "
                  "by {:.2g} %, "
                  "{} dead pixel{}.",
                  100 * uniformity.spread, uniformity.dead, uniformity.dead == 1 ? "" : "s"));
  return {header, [source = std::move(recording), uniformity](std::size_t index, Frame& frame) {
            frame = source.frame(index);
            correct(uniformity, frame.values, source.header().saturation,
                    source.header().under_range);
          }};
}

}  // namespace

Recording apply(const Settings& settings, Recording recording) {
  if (!settings.uniform_cold.empty() || !settings.uniform_hot.empty())
    recording = made_uniform(settings, std::move(recording));
  if (!settings.spectral_response.empty()) {
    if (!recording.header().radiometry)
      throw InputError(
          fmt::format("{}: spectral_response was given, but the file holds no gain, "
                      "so a radiance has no signal; leave it out.",
                      recording.header().path.string()));
    std::vector<Spectrum> spectra = {read_spectrum(settings.spectral_response)};
    if (!settings.window_spectrum.empty()) {
      if (settings.transmission)
        throw InputError(
            "window_spectrum and transmission both say what the windows transmit; "
            "give one of them.");
      spectra.push_back(read_spectrum(settings.window_spectrum));
      recording.header().radiometry->transmission = 1;
    }
    recording.header().radiometry->spectrum = std::make_shared<Spectrum>(product(spectra));
  } else if (!settings.window_spectrum.empty()) {
    throw InputError("window_spectrum is used with spectral_response; give that as well.");
  }
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

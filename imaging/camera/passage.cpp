// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/camera/passage.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <opencv2/imgproc.hpp>

namespace meltproof::imaging {
namespace {

/// The scaled enthalpy at which the last solid melts.
RosenthalSettings at_liquidus_enthalpy(const PassageSettings& s) {
  RosenthalSettings source = s.source;
  source.reference_temperature += s.solidification.latent_heat;
  source.peak_temperature += s.solidification.latent_heat;
  return source;
}

/// The signal of the pool on a fine grid of `samples` a pixel that spans one image to either side
/// of the source.
cv::Mat expose_once(const PassageSettings& s, const Camera& camera) {
  CameraSettings wide = s.camera;
  wide.width = 2 * s.camera.width + 8;
  const double motion = s.source.scan_speed * s.camera.integration_time;
  const SceneGrid grid(wide, 0, motion);
  const cv::Mat signal =
      camera.expose_finely(render_scene(solidifying_field(s), grid), grid, motion);
  return signal(grid.image());
}

/// Cubic interpolation (Keys 1981, a = -1/2) between four samples.
double cubic(const double* p, double t) {
  return p[1] +
         0.5 * t *
             (p[2] - p[0] +
              t * (2 * p[0] - 5 * p[1] + 4 * p[2] - p[3] + t * (3 * (p[1] - p[2]) + p[3] - p[0])));
}

}  // namespace

std::function<RayHit(double, double)> solidifying_field(const PassageSettings& s) {
  const RosenthalSettings source = at_liquidus_enthalpy(s);
  const bool side = source.view == "side";
  const double latent = s.solidification.latent_heat;
  const double liquidus = s.source.reference_temperature;
  const double solidus = latent > 0 ? liquidus - s.solidification.interval : liquidus;
  const double span = liquidus - solidus + latent;  // of enthalpy, over the mushy range
  const double liquid = s.camera.emissivity_liquid, solid = s.camera.emissivity_solid;
  return [=](double u, double v) -> RayHit {
    if (side && v > 0) return {std::numeric_limits<double>::quiet_NaN(), 1};
    const double enthalpy = std::min(
        side ? rosenthal_temperature(source, u, 0, v) : rosenthal_temperature(source, u, v, 0),
        source.peak_temperature);
    if (enthalpy >= solidus + span) return {enthalpy - latent, liquid};
    if (enthalpy <= solidus || !(span > 0)) return {enthalpy, solid};
    const double fraction = (enthalpy - solidus) / span;
    return {solidus + fraction * (liquidus - solidus), solid + fraction * (liquid - solid)};
  };
}

FilmedPassage film_passage(const PassageSettings& s) {
  const Camera camera(s.camera);
  const cv::Mat fine = expose_once(s, camera);
  const auto samples = static_cast<double>(s.camera.supersampling);
  const auto width = static_cast<std::size_t>(s.camera.width);
  const auto height = static_cast<std::size_t>(s.camera.height);
  const RosenthalPool pool = rosenthal_pool(at_liquidus_enthalpy(s));

  FilmedPassage passage;
  passage.length = pool.length;
  passage.depth = s.source.view == "side" ? 0.5 * pool.width : pool.width;
  passage.step = s.source.scan_speed / s.camera.frame_rate / s.camera.pixel_size;
  passage.liquid_signal =
      signal(camera.radiometry(), s.source.reference_temperature, s.camera.emissivity_liquid);
  passage.solid_signal =
      signal(camera.radiometry(), s.source.reference_temperature, s.camera.emissivity_solid);

  Noise noise(s.seed);
  std::vector<double> gain(width * height, 1);
  if (s.non_uniformity > 0)
    for (auto& g : gain) g += s.non_uniformity * noise.normal();
  const double middle = 0.5 * static_cast<double>(fine.cols);  // of the source, on the fine grid
  for (long long i = 0; i < s.source.frames; ++i) {
    const double source = s.start + passage.step * static_cast<double>(i);
    std::vector<float> frame(width * height);
    for (std::size_t y = 0; y < height; ++y) {
      // Pixels are averaged around fine samples between their two middle ones.
      const auto row = static_cast<int>(static_cast<double>(y) * samples + 0.5 * samples);
      const double* line = fine.ptr<double>(std::min(row, fine.rows - 1));
      for (std::size_t x = 0; x < width; ++x) {
        const double at = middle + (static_cast<double>(x) - source) * samples;
        const double cell = std::clamp(std::floor(at), 1.0, static_cast<double>(fine.cols - 3));
        double light =
            cubic(line + static_cast<std::ptrdiff_t>(cell) - 1, at - cell) - s.camera.dark;
        for (const Bright& b : s.bright) {
          const auto frame_number = static_cast<std::size_t>(i);
          if (frame_number < b.first || frame_number > b.last) continue;
          const auto age = static_cast<double>(frame_number - b.first);
          const double dx = static_cast<double>(x) - b.column - b.column_speed * age;
          const double dy = static_cast<double>(y) - b.row - b.row_speed * age;
          light += b.signal * std::exp(-0.5 * (dx * dx + dy * dy) / (b.radius * b.radius));
        }
        const double value = s.camera.dark + gain[y * width + x] * light +
                             (s.read_noise > 0 ? s.read_noise * noise.normal() : 0);
        frame[y * width + x] = static_cast<float>(std::min(value, s.camera.full_scale()));
      }
    }
    passage.frames.push_back(std::move(frame));
  }
  return passage;
}

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/camera/scale_scene.hpp"

#include <cmath>
#include <numbers>

#include "imaging/camera/noise.hpp"

namespace meltproof::imaging {

cv::Mat render_scale(const ScaleScene& scene) {
  constexpr int samples = 8;
  cv::Mat image(scene.height, scene.width, CV_32F);
  Noise noise(scene.seed);
  const double fx = std::cos(scene.angle) * scene.pixel_size_x / scene.period;
  const double fy = std::sin(scene.angle) * scene.pixel_size_y / scene.period;
  const double frequency = std::hypot(fx, fy);  // 1/px
  const double half_width = 0.5 * scene.line_width / scene.period;
  const double spread = std::numbers::sqrt2 * scene.point_spread * frequency;  // in periods
  const double corner = 0.25 * (scene.width * scene.width + scene.height * scene.height);
  for (int row = 0; row < scene.height; ++row) {
    for (int column = 0; column < scene.width; ++column) {
      double sum = 0;
      for (int k = 0; k < samples * samples; ++k) {
        const double x = column + (k % samples + 0.5) / samples - 0.5 * scene.width;
        const double y = row + (k / samples + 0.5) / samples - 0.5 * scene.height;
        const double along = fx * x + fy * y;
        // The drift is that of a phase whose derivative changes linearly along the image's width.
        const double p =
            along -
            0.5 * scene.period_drift * along * along / (fx * scene.width + fy * scene.height) -
            scene.phase;
        const double nearest = std::round(p);
        for (double line = nearest - 3; line <= nearest + 3; ++line)
          sum += 0.5 * (std::erf((p - line + half_width) / spread) -
                        std::erf((p - line - half_width) / spread));
      }
      const double x = column + 0.5 - 0.5 * scene.width, y = row + 0.5 - 0.5 * scene.height;
      const double light = 1 - scene.vignette * (x * x + y * y) / corner;
      image.at<float>(row, column) =
          static_cast<float>(light * (scene.glass + scene.contrast * sum / (samples * samples)) +
                             scene.noise * noise.normal());
    }
  }
  return image;
}

}  // namespace meltproof::imaging

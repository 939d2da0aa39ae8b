// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/camera/section.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

namespace meltproof::imaging {
namespace {

/// Sums of one slab on the scene's grid.
struct Slab {
  cv::Mat weight, temperature, emissivity;
  explicit Slab(cv::Size size)
      : weight(size, CV_64F), temperature(size, CV_64F), emissivity(size, CV_64F) {}
};

}  // namespace

Scene render_section(const ParticleSnapshot& snapshot, const CameraSettings& camera,
                     const SceneGrid& grid) {
  const cv::Size size(grid.columns(), grid.rows());
  Scene scene{cv::Mat(size, CV_64F, cv::Scalar(std::numeric_limits<double>::quiet_NaN())),
              cv::Mat(size, CV_64F, cv::Scalar(1))};
  const double spacing = snapshot.spacing, radius = 2 * spacing;
  const double reach = radius / grid.step();

  // Particles by slab; those whose kernel does not touch the grid are left out.
  std::vector<std::vector<std::size_t>> slabs;
  for (std::size_t i = 0; i < snapshot.temperature.size(); ++i) {
    const double* at = &snapshot.position[3 * i];
    // A layer that lies in the plane belongs behind it, whatever the last digits of a float say.
    const double depth = camera.direction() * (at[1] - camera.section) / spacing + 1e-4;
    if (!(depth >= 0)) continue;
    const double column = grid.column(at[0]), row = grid.row(at[2]);
    if (column < -reach || row < -reach || column > size.width + reach || row > size.height + reach)
      continue;
    const auto slab = static_cast<std::size_t>(depth);
    if (slab >= slabs.size()) slabs.resize(slab + 1);
    slabs[slab].push_back(i);
  }

  Slab sums(size);
  const double normal = 7 / (std::numbers::pi * 4);  // of the kernel, times spacing^2
  for (const auto& particles : slabs) {
    if (particles.empty()) continue;
    sums.weight.setTo(0), sums.temperature.setTo(0), sums.emissivity.setTo(0);
    for (const std::size_t i : particles) {
      const double column = grid.column(snapshot.position[3 * i]);
      const double row = grid.row(snapshot.position[3 * i + 2]);
      const double liquid = std::clamp(snapshot.liquid_fraction[i], 0.0, 1.0);
      const double emissivity =
          camera.emissivity_solid + liquid * (camera.emissivity_liquid - camera.emissivity_solid);
      const int first_row = std::max(0, static_cast<int>(std::ceil(row - reach)));
      const int last_row = std::min(size.height - 1, static_cast<int>(std::floor(row + reach)));
      const int first = std::max(0, static_cast<int>(std::ceil(column - reach)));
      const int last = std::min(size.width - 1, static_cast<int>(std::floor(column + reach)));
      for (int r = first_row; r <= last_row; ++r) {
        auto* const weight = sums.weight.ptr<double>(r);
        auto* const temperature = sums.temperature.ptr<double>(r);
        auto* const emitted = sums.emissivity.ptr<double>(r);
        for (int c = first; c <= last; ++c) {
          const double q = std::hypot(c - column, r - row) / reach;
          if (q >= 1) continue;
          const double p = (1 - q) * (1 - q), w = p * p * (1 + 4 * q);
          weight[c] += w;
          temperature[c] += w * snapshot.temperature[i];
          emitted[c] += w * emissivity;
        }
      }
    }
    for (int r = 0; r < size.height; ++r)
      for (int c = 0; c < size.width; ++c) {
        double& temperature = scene.temperature.at<double>(r, c);
        const double weight = sums.weight.at<double>(r, c);
        if (!std::isnan(temperature) || normal * weight < 0.5) continue;
        temperature = sums.temperature.at<double>(r, c) / weight;
        scene.emissivity.at<double>(r, c) = sums.emissivity.at<double>(r, c) / weight;
      }
  }
  return scene;
}

std::string section_statement(const CameraSettings& camera) {
  return fmt::format(
      "Seen along {}: on each ray the first metal at or behind the plane y = {} um (the track is "
      "cut there, "
      "as at the edge of the paper's plate); columns along {}x, rows along -z; rays without metal "
      "see "
      "the surroundings at {} K.",
      camera.look, camera.section * 1e6, camera.direction() > 0 ? "+" : "-",
      camera.ambient_temperature);
}

}  // namespace meltproof::imaging

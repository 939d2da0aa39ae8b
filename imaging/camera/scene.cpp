// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/camera/scene.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace meltproof::imaging {

SceneGrid::SceneGrid(const CameraSettings& camera, double centre, double motion)
    : samples_(static_cast<int>(camera.supersampling)),
      u_direction_(camera.direction()),
      step_(camera.pixel_size / static_cast<double>(camera.supersampling)) {
  const int width = static_cast<int>(camera.width), height = static_cast<int>(camera.height);
  const int margin = 1 + static_cast<int>(std::ceil(4 * camera.point_spread +
                                                    0.5 * std::abs(motion) / camera.pixel_size));
  columns_ = (width + 2 * margin) * samples_;
  rows_ = (height + 2 * margin) * samples_;
  image_ = cv::Rect(margin * samples_, margin * samples_, width * samples_, height * samples_);
  origin_u_ = centre - u_direction_ * 0.5 * step_ * (columns_ - 1);
  // Row r of the image has its centre (r + 1/2) pixels below the image's upper border.
  origin_v_ = camera.pixel_size * (camera.surface_row + 0.5 + margin) - 0.5 * step_;
}

double SceneGrid::first_pixel_u() const { return u(image_.x + 0.5 * (samples_ - 1)); }
double SceneGrid::first_pixel_v() const { return v(image_.y + 0.5 * (samples_ - 1)); }
double SceneGrid::pixel_column(double at) const {
  return (column(at) - image_.x - 0.5 * (samples_ - 1)) / samples_;
}

Scene render_scene(const std::function<RayHit(double u, double v)>& field, const SceneGrid& grid) {
  Scene scene{cv::Mat(grid.rows(), grid.columns(), CV_64F),
              cv::Mat(grid.rows(), grid.columns(), CV_64F)};
  for (int row = 0; row < grid.rows(); ++row)
    for (int column = 0; column < grid.columns(); ++column) {
      const RayHit hit = field(grid.u(column), grid.v(row));
      scene.temperature.at<double>(row, column) = hit.temperature;
      scene.emissivity.at<double>(row, column) = hit.emissivity;
    }
  return scene;
}

VisiblePool visible_pool(const Scene& scene, const SceneGrid& grid, double reference_temperature) {
  const cv::Mat above = scene.temperature >= reference_temperature;  // false for NaN
  cv::Mat labels, statistics, centroids;
  const int count = cv::connectedComponentsWithStats(above, labels, statistics, centroids, 8);
  VisiblePool pool;
  int largest = 0;
  for (int i = 1; i < count; ++i) {
    if (statistics.at<int>(i, cv::CC_STAT_AREA) <= largest) continue;
    largest = statistics.at<int>(i, cv::CC_STAT_AREA);
    pool.length = grid.step() * statistics.at<int>(i, cv::CC_STAT_WIDTH);
    pool.depth = grid.step() * statistics.at<int>(i, cv::CC_STAT_HEIGHT);
  }
  return pool;
}

Camera::Camera(const CameraSettings& settings)
    : settings_(settings),
      radiometry_(camera_radiometry(settings)),
      band_(settings.band_lower, settings.band_upper) {}

/// Radiance after motion and point spread, on the fine grid.
cv::Mat Camera::optical_radiance(const Scene& scene, const SceneGrid& grid, double motion) const {
  const double surroundings = band_.radiance(settings_.ambient_temperature);
  cv::Mat radiance(scene.temperature.size(), CV_64F);
  for (int row = 0; row < radiance.rows; ++row)
    for (int column = 0; column < radiance.cols; ++column) {
      const double t = scene.temperature.at<double>(row, column);
      const double e = scene.emissivity.at<double>(row, column);
      radiance.at<double>(row, column) =
          std::isnan(t) ? surroundings : e * band_.radiance(t) + (1 - e) * surroundings;
    }
  // Over the integration time the picture moves by `motion`: a box along the columns, with
  // fractions of a sample at its ends.
  const double length = std::abs(motion) / grid.step();
  if (length > 0) {
    const int reach = static_cast<int>(std::ceil(0.5 * length + 0.5));
    cv::Mat box(1, 2 * reach + 1, CV_64F);
    for (int i = -reach; i <= reach; ++i)
      box.at<double>(i + reach) =
          std::max(0.0, std::min(i + 0.5, 0.5 * length) - std::max(i - 0.5, -0.5 * length)) /
          length;
    cv::filter2D(radiance, radiance, -1, box, {-1, -1}, 0, cv::BORDER_REPLICATE);
  }
  if (settings_.point_spread > 0)
    cv::GaussianBlur(radiance, radiance, {},
                     settings_.point_spread * static_cast<double>(settings_.supersampling), 0,
                     cv::BORDER_REPLICATE);
  return radiance;
}

cv::Mat Camera::to_counts(const cv::Mat& radiance) const {
  const Radiometry& r = radiometry_;
  const double window =
      r.window_emission ? (1 - r.transmission) * band_.radiance(r.window_temperature) : 0.0;
  return r.gain * r.integration_time * (r.transmission * radiance + window) + r.dark;
}

cv::Mat Camera::expose(const Scene& scene, const SceneGrid& grid, double motion) const {
  cv::Mat pixels;
  cv::resize(optical_radiance(scene, grid, motion)(grid.image()), pixels,
             {static_cast<int>(settings_.width), static_cast<int>(settings_.height)}, 0, 0,
             cv::INTER_AREA);
  return to_counts(pixels);
}

cv::Mat Camera::expose_finely(const Scene& scene, const SceneGrid& grid, double motion) const {
  const int samples = static_cast<int>(settings_.supersampling);
  cv::Mat mean;
  cv::blur(optical_radiance(scene, grid, motion), mean, {samples, samples},
           {samples / 2, samples / 2}, cv::BORDER_REPLICATE);
  return to_counts(mean);
}

std::vector<std::uint16_t> Camera::detect(const cv::Mat& signal, Noise& noise) const {
  const double full = settings_.full_scale();
  const double electrons_per_count = settings_.full_well / (full - settings_.dark);
  std::vector<std::uint16_t> counts;
  counts.reserve(signal.total());
  for (int row = 0; row < signal.rows; ++row)
    for (int column = 0; column < signal.cols; ++column) {
      const double value = signal.at<double>(row, column);
      const double shot =
          std::sqrt(std::max(value - settings_.dark, 0.0) / electrons_per_count) * noise.normal();
      const double read = settings_.read_noise * noise.normal();
      counts.push_back(
          static_cast<std::uint16_t>(std::clamp(std::round(value + shot + read), 0.0, full)));
    }
  return counts;
}

}  // namespace meltproof::imaging

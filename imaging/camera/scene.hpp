// SPDX-License-Identifier: GPL-3.0-or-later
// From a field of temperature and emissivity to the counts of a frame.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <opencv2/core.hpp>

#include "imaging/camera/noise.hpp"
#include "imaging/camera/settings.hpp"

namespace meltproof::imaging {

/// What one ray meets. A temperature that is not a number: no metal, the ray sees the surroundings.
struct RayHit {
  double temperature = 0;  ///< K
  double emissivity = 1;   ///< 1
};

/// The fine grid on which a scene is sampled: `supersampling` points per pixel and axis, and a
/// margin on all sides from which point spread and motion carry light into the image. Place of a
/// point: u along image columns, v upwards against image rows, both in metres and in the scene's
/// own coordinates.
class SceneGrid {
 public:
  /// @param centre u at the middle of the image; @param motion m, largest shift during a frame.
  SceneGrid(const CameraSettings& camera, double centre, double motion);
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  double step() const { return step_; }  ///< m
  double u(double column) const { return origin_u_ + u_direction_ * step_ * column; }
  double v(double row) const { return origin_v_ - step_ * row; }
  /// Fractional grid column and row of a place.
  double column(double u) const { return u_direction_ * (u - origin_u_) / step_; }
  double row(double v) const { return (origin_v_ - v) / step_; }
  /// The part of the grid that the image covers.
  cv::Rect image() const { return image_; }
  /// u and v at the centre of the image's first pixel, and the image column of a place, px.
  double first_pixel_u() const;
  double first_pixel_v() const;
  double pixel_column(double u) const;

 private:
  int samples_, columns_, rows_, u_direction_;
  double step_, origin_u_, origin_v_;
  cv::Rect image_;
};

/// A scene on its grid, CV_64F; temperature is NaN where there is no metal.
struct Scene {
  cv::Mat temperature, emissivity;
};

/// Samples a field of rays, for analytic scenes. field(u, v) is called once per point of the grid.
Scene render_scene(const std::function<RayHit(double u, double v)>& field, const SceneGrid& grid);

/// Extent of the largest connected part of a scene at or above a temperature, before any optics.
struct VisiblePool {
  double length = 0, depth = 0;  ///< m along u and v; 0 if there is none
};
VisiblePool visible_pool(const Scene& scene, const SceneGrid& grid, double reference_temperature);

/// The camera: optics and sensor with their table of radiance.
class Camera {
 public:
  explicit Camera(const CameraSettings& settings);
  const CameraSettings& settings() const { return settings_; }
  const Radiometry& radiometry() const { return radiometry_; }

  /// The noise-free signal, height x width CV_64F, counts: radiance of every point, shifted along u
  /// over `motion` (m, during the integration time, centred on the scene's instant), spread by the
  /// optics, averaged over each pixel, through windows and gain. May exceed full scale.
  cv::Mat expose(const Scene& scene, const SceneGrid& grid, double motion) const;

  /// The same on every point of the fine grid, as if a pixel were centred half a step before it
  /// (towards the first row and column): the mean over a pixel's area, CV_64F, counts.
  cv::Mat expose_finely(const Scene& scene, const SceneGrid& grid, double motion) const;

  /// What the sensor makes of it: shot noise of the electrons (Gaussian, of variance equal to their
  /// number) and read noise, rounded to whole counts, cut off at 0 and at full scale.
  std::vector<std::uint16_t> detect(const cv::Mat& signal, Noise& noise) const;

 private:
  cv::Mat optical_radiance(const Scene& scene, const SceneGrid& grid, double motion) const;
  cv::Mat to_counts(const cv::Mat& radiance) const;

  CameraSettings settings_;
  Radiometry radiometry_;
  BandTable band_;
};

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// What the virtual camera is: every number with its default and where that comes from.
#pragma once

#include <optional>
#include <string>

#include "base/input.hpp"
#include "imaging/camera/scale_scene.hpp"
#include "imaging/radiometry/radiometry.hpp"

namespace meltproof::imaging {

/// The camera, its optics and its place. All SI; lengths are on the object.
struct CameraSettings {
  // Sensor
  long long width = 96, height = 40;  ///< px
  double frame_rate = 9762.5;         ///< Hz
  double integration_time = 20e-6;    ///< s
  long long bits = 14;
  double dark = 200;  ///< counts without light
  double saturation_temperature =
      3500;                ///< K, of liquid metal that fills the counts; sets the gain
  double full_well = 7e6;  ///< electrons at full counts; sets the shot noise
  double read_noise = 2;   ///< counts, sigma
  // Optics
  double pixel_size = 17.6e-6;                  ///< m
  double band_lower = 3e-6, band_upper = 5e-6;  ///< m
  double transmission = 0.7257 * 0.4313;        ///< 1
  double point_spread = 0.8;                    ///< px, sigma of a Gaussian
  long long supersampling = 8;                  ///< points per pixel and axis
  // Surface and surroundings
  double emissivity_liquid = 0.2, emissivity_solid = 0.3;
  double ambient_temperature =
      293.15;  ///< K, of what the metal reflects and of rays that meet none
  bool window_emission = false;
  double window_temperature = 293.15;  ///< K
  // View
  double section = 0;       ///< m, y of the plane at or behind which metal is seen
  std::string look = "+y";  ///< "+y" or "-y"
  double surface_row =
      12;  ///< px, image row (pixel centres) in which the plate's surface z = 0 lies
  std::optional<double> centre;  ///< m, x at the middle of the image; default: middle of the track

  /// +1 or -1: along y, and of x along image columns.
  int direction() const { return look == "-y" ? -1 : 1; }
  /// Largest count.
  double full_scale() const { return static_cast<double>((1LL << bits) - 1); }
};

/// A moving point source on a half-space (Rosenthal 1946) for recordings without a solver run.
struct RosenthalSettings {
  double initial_temperature = 300;        ///< K
  double absorbed_power = 60;              ///< W
  double conductivity = 30;                ///< W m-1 K-1
  double diffusivity = 5.5e-6;             ///< m2 s-1
  double scan_speed = 0.375;               ///< m s-1
  double reference_temperature = 1673.15;  ///< K: liquid at and above it
  double peak_temperature = 3100;          ///< K; the singular source is cut off here
  long long frames = 44;                   ///< the beam's passage through the image
  std::string view = "side";  ///< "side": section y = 0, z up; "top": surface z = 0, y up
};

/// Declares [sensor], [optics], [surface], [view], [rosenthal] and [scale] of the settings file,
/// bound to the given variables, which must outlive the result.
Input declare_settings(CameraSettings& camera, RosenthalSettings& rosenthal, ScaleScene& scale);

/// The radiometry that the settings amount to, with the emissivity of the solid (what surrounds a
/// melt pool's outline) and the gain at which liquid metal of saturation_temperature fills the
/// counts.
Radiometry camera_radiometry(const CameraSettings& camera);

}  // namespace meltproof::imaging

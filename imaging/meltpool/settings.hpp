// SPDX-License-Identifier: GPL-3.0-or-later
// What a user can say about a recording, declared once for the settings file and the command line.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/input.hpp"
#include "imaging/meltpool/measurement.hpp"
#include "imaging/recording/options.hpp"

namespace meltproof::imaging {

struct Settings {
  std::optional<double> level, reference_temperature, emissivity, emissivity_liquid, transmission;
  std::optional<double> frame_rate;        ///< Hz, for files that do not hold one
  std::optional<double> kelvin_per_count;  ///< K, for files whose counts are a linear temperature
  double zero_count_temperature = 0;       ///< K at count 0 of that scale
  std::optional<double> scan_speed;        ///< m/s, to check the measured one
  std::string scan_direction = "+x";
  std::string reference_signal = "auto";
  std::optional<double> dark;  ///< counts without light, for files that do not hold it
  BudgetSettings budget;
  std::optional<double> point_spread, u_point_spread;  ///< px, in front of all other sources
  ReferenceRules rules;
  long long fewest_lines = 3;
  std::filesystem::path spectral_response, window_spectrum;
  std::filesystem::path uniform_cold, uniform_hot;
  std::filesystem::path calibration;
  ReadOptions reading;                            ///< but for the two numbers
  long long preamble_lines = -1, frame_rows = 0;  ///< as the file says
  /// How to open a recording.
  ReadOptions read_options() const;
  LevelRequest request() const {
    return {level, reference_temperature, emissivity, emissivity_liquid, transmission};
  }
  /// @throws InputError for a scan direction or search that there is not.
  MeasurementRequest measurement(const PixelSize& pixel, double spread, double u_spread) const;
};

/// The declaration of the settings, bound to `settings`.
Input declare(Settings& settings);

/// The pixel size that `meltproof-calibrate` has written: pixel_size_x_um, pixel_size_y_um and,
/// where they are given, u_pixel_size_x_um, u_pixel_size_y_um.
/// @throws InputError if the file is no JSON or a size is missing or not positive.
PixelSize read_pixel_size(const std::filesystem::path& calibration);

/// The optics' point spread, sigma in pixels, and who says so.
struct PointSpread {
  double sigma = 0, u = 0;
  std::string source;  ///< "given", "calibration", "file" or "default"
};
/// The first that is known: the settings, the blur of the edges in the calibration less that of a
/// pixel's own area (variance 1/12), what the file says, the default of BudgetSettings.
PointSpread point_spread_of(const Settings& settings, const RecordingHeader& header);

/// What the settings make of a recording: a temperature scale, a frame rate.
/// @throws InputError if they contradict what the file holds.
Recording apply(const Settings& settings, Recording recording);

}  // namespace meltproof::imaging

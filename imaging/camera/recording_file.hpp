// SPDX-License-Identifier: GPL-3.0-or-later
// The recording that the virtual camera writes: the form of a measured one, and said to be
// synthetic.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/artifact.hpp"
#include "base/provenance.hpp"
#include "imaging/camera/settings.hpp"

namespace meltproof::imaging {

/// Facts of the scene behind a frame, before any optics. A reader of measurements never looks at
/// them; tests and the comparison of optics with physics do.
struct FrameTruth {
  double beam_column = 0;  ///< px, image column of the beam's axis
  double visible_length =
      0;  ///< m, extent of what is at or above the reference temperature, along columns
  double visible_depth = 0;  ///< m, along rows
};

/// Writes a recording frame by frame; nothing is left behind without commit().
class RecordingFile {
 public:
  /// @param synthetic how the recording was made, never empty; @param seen what the picture shows.
  /// @throws InputError as ArtifactWriter does.
  RecordingFile(const std::filesystem::path& path, const std::string& synthetic,
                const std::string& seen, std::size_t width, std::size_t height);
  /// @param counts height * width, row-major; @param time s.
  void add(const std::vector<std::uint16_t>& counts, double time, const FrameTruth& truth = {});
  /// Adds what is known of the sensor. @param pixel_size m; 0 where it is what the recording is to
  /// tell.
  void describe_sensor(const CameraSettings& camera, double pixel_size);
  /// Adds what turns counts into temperature. `r` carries the gain that was used.
  void describe_radiometry(const CameraSettings& camera, const Radiometry& r);
  /// Adds what is known of the scene. @param scan_speed m s-1; @param reference_temperature K;
  /// @param x, z place of the first pixel's centre in the run's coordinates, m.
  void describe_scene(double scan_speed, double reference_temperature, double x, double z);
  /// A fact of the scene under truth/.
  void truth(const std::string& name, double value, const std::string& unit,
             const std::string& description);
  std::size_t frames() const { return times_.size(); }
  void commit(Provenance provenance);

 private:
  ArtifactWriter writer_;
  std::size_t width_, height_;
  std::vector<double> times_, columns_, lengths_, depths_;
  bool has_scene_ = false;
};

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// From a synthetic passage to a recording in memory, for tests of camera and measurement together.
#pragma once

#include <algorithm>

#include "imaging/camera/passage.hpp"
#include "imaging/meltpool/measurement.hpp"

namespace meltproof::imaging {

/// Sets the read noise to a part of the signal that liquid metal has at the reference temperature.
inline void set_signal_to_noise(PassageSettings& s, double ratio) {
  const Radiometry r = camera_radiometry(s.camera);
  s.read_noise =
      (signal(r, s.source.reference_temperature, s.camera.emissivity_liquid) - s.camera.dark) / ratio;
}

/// The frames as a recording with the camera's radiometry.
inline Recording recording_of(const FilmedPassage& film, const PassageSettings& s) {
  RecordingHeader h;
  h.path = "synthetic";
  h.synthetic = "computed by a test";
  h.width = static_cast<std::size_t>(s.camera.width);
  h.height = static_cast<std::size_t>(s.camera.height);
  h.frames = film.frames.size();
  h.frame_rate = s.camera.frame_rate;
  h.integration_time = s.camera.integration_time;
  h.saturation = s.camera.full_scale();
  h.radiometry = camera_radiometry(s.camera);
  return {h, [frames = film.frames](std::size_t index, Frame& frame) {
            std::copy(frames[index].begin(), frames[index].end(), frame.values.begin());
          }};
}

}  // namespace meltproof::imaging

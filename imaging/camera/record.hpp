// SPDX-License-Identifier: GPL-3.0-or-later
// The three scenes of the virtual camera, from file or settings to a recording.
#pragma once

#include <cstdint>
#include <filesystem>

#include "base/provenance.hpp"
#include "imaging/camera/settings.hpp"

namespace meltproof::imaging {

/// What was written.
struct Recorded {
  std::size_t frames = 0;
  std::size_t left_out =
      0;  ///< snapshots that are no frames of this camera, such as the last, cold one
};

/// Films a run ("meltproof run" artifact) from the side. Its frames are the snapshots from the
/// first on that follow each other at the camera's frame rate, to 1 % of a frame.
/// @throws InputError if the file is no run, lacks something, or its snapshots are spaced
/// otherwise.
Recorded record_run(const std::filesystem::path& run, const std::filesystem::path& output,
                    const CameraSettings& camera, std::uint64_t seed, Provenance provenance);

/// Films an analytic pool that passes through the image from one side to the other.
Recorded record_rosenthal(const std::filesystem::path& output, const CameraSettings& camera,
                          const RosenthalSettings& source, std::uint64_t seed,
                          Provenance provenance);

/// One image of a glass scale; pixel size and format are the camera's.
Recorded record_scale(const std::filesystem::path& output, const CameraSettings& camera,
                      ScaleScene scale, std::uint64_t seed, Provenance provenance);

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// The moving point source on a half-space: a melt pool of known length, width and depth.
#pragma once

#include "imaging/camera/scene.hpp"
#include "imaging/camera/settings.hpp"

namespace meltproof::imaging {

/// T = T0 + Q / (2 pi k R) exp(-v (xi + R) / (2 alpha)), R^2 = xi^2 + y^2 + z^2 (Rosenthal, Trans.
/// ASME 68, 1946), xi ahead of the source, m. Infinite at the source. K.
double rosenthal_temperature(const RosenthalSettings& source, double xi, double y, double z);

/// Size of the pool at the reference temperature, m; the depth is half the width.
struct RosenthalPool {
  double length = 0, width = 0;
};
RosenthalPool rosenthal_pool(const RosenthalSettings& source);

/// The field that a camera sees when the source is at u = `position`: from the side the section y =
/// 0 with z = v <= 0, from above the surface with y = v. Liquid where the reference temperature is
/// reached; cut off at the peak temperature.
std::function<RayHit(double, double)> rosenthal_field(const RosenthalSettings& source,
                                                      const CameraSettings& camera,
                                                      double position);

}  // namespace meltproof::imaging

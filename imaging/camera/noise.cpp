// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/camera/noise.hpp"

#include <cmath>
#include <numbers>

namespace meltproof::imaging {

double Noise::uniform() { return (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53; }

double Noise::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2 * std::log(uniform()));
  const double angle = 2 * std::numbers::pi * uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

}  // namespace meltproof::imaging

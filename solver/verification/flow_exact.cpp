// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/verification/flow_exact.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "base/error.hpp"

namespace meltproof::solver {

ShearFlow::ShearFlow(std::vector<ShearLayer> layers, double upper_speed)
    : layers_(std::move(layers)) {
  if (layers_.empty()) {
    throw std::logic_error("a flow between plates has at least one layer");
  }
  // The speed on top is linear in the stress at the foot: two trials give it.
  const auto top = [&](double stress) {
    stress_.clear();
    speed_.clear();
    double speed = 0;
    for (const ShearLayer& layer : layers_) {
      stress_.push_back(stress);
      speed_.push_back(speed);
      const double h = layer.thickness;
      speed += (stress * h - layer.force * h * h / 2) / layer.viscosity;
      stress -= layer.force * h;
    }
    return speed;
  };
  const double none = top(0), one = top(1);
  top((upper_speed - none) / (one - none));
}

double ShearFlow::operator()(double y) const {
  std::size_t k = 0;
  while (k + 1 < layers_.size() && y > layers_[k].thickness) {
    y -= layers_[k++].thickness;
  }
  return speed_[k] + (stress_[k] * y - layers_[k].force * y * y / 2) / layers_[k].viscosity;
}

double taylor_green_rate(double reynolds) {
  return -8 * std::numbers::pi * std::numbers::pi / reynolds;
}

CavityReference cavity_reference(double reynolds) {
  CavityReference r;
  r.y = {0.0547, 0.0625, 0.0703, 0.1016, 0.1719, 0.2813, 0.4531, 0.5,
         0.6172, 0.7344, 0.8516, 0.9531, 0.9609, 0.9688, 0.9766};
  r.x = {0.0625, 0.0703, 0.0781, 0.0938, 0.1563, 0.2266, 0.2344, 0.5,
         0.8047, 0.8594, 0.9063, 0.9453, 0.9531, 0.9609, 0.9688};
  if (reynolds == 100) {
    r.u = {-0.03717, -0.04192, -0.04775, -0.06434, -0.10150, -0.15662, -0.21090, -0.20581,
           -0.13641, 0.00332,  0.23151,  0.68717,  0.73722,  0.78871,  0.84123};
    r.v = {0.09233,  0.10091,  0.10890,  0.12317,  0.16077,  0.17507,  0.17527, 0.05454,
           -0.24533, -0.22445, -0.16914, -0.10313, -0.08864, -0.07391, -0.05906};
  } else if (reynolds == 1000) {
    r.u = {-0.18109, -0.20196, -0.22220, -0.29730, -0.38289, -0.27805, -0.10648, -0.06080,
           0.05702,  0.18719,  0.33304,  0.46604,  0.51117,  0.57492,  0.65928};
    r.v = {0.27485,  0.29012,  0.30353,  0.32627,  0.37095,  0.33075,  0.32235, 0.02526,
           -0.31966, -0.42665, -0.51550, -0.39188, -0.33714, -0.27669, -0.21388};
  } else {
    throw InputError(fmt::format(
        "reynolds {}: reference values of the cavity are there for 100 and 1000", reynolds));
  }
  return r;
}

double migration_speed(double tension_slope, double temperature_gradient, double radius,
                       double viscosity, double viscosity_drop, double conductivity,
                       double conductivity_drop) {
  return 2 * std::abs(tension_slope * temperature_gradient) * radius /
         ((2 * viscosity + 3 * viscosity_drop) * (2 + conductivity_drop / conductivity));
}

}  // namespace meltproof::solver

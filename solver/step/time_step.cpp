// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/step/time_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace meltproof::solver {

StepLimits step_limits(const StepExtremes& e) {
  StepLimits limits;
  const double h = e.smoothing_length;
  if (e.sound_speed > 0) {
    limits.acoustic = e.courant * h / (e.sound_speed + e.speed);
  }
  if (e.kinematic_viscosity > 0) {
    limits.viscous = 0.125 * h * h / e.kinematic_viscosity;
  }
  if (e.surface_tension > 0) {
    limits.capillary =
        0.25 * std::sqrt(e.density * h * h * h / (2 * std::numbers::pi * e.surface_tension));
  }
  if (e.thermal_diffusivity > 0) {
    limits.thermal = 0.125 * h * h / e.thermal_diffusivity;
  }
  if (e.species_diffusivity > 0) {
    limits.species = 0.125 * h * h / e.species_diffusivity;
  }
  if (e.gravity > 0) {
    limits.gravity = 0.25 * std::sqrt(h / e.gravity);
  }
  if (e.surface_rate > 0) {
    limits.surface = 0.5 / e.surface_rate;
  }
  return limits;
}

double StepLimits::smallest() const {
  return std::min({acoustic, viscous, capillary, thermal, species, gravity, surface});
}

std::string StepLimits::smallest_name() const {
  const std::array<std::pair<double, const char*>, 7> all{{{acoustic, "acoustic"},
                                                           {viscous, "viscous"},
                                                           {capillary, "capillary"},
                                                           {thermal, "thermal"},
                                                           {species, "species"},
                                                           {gravity, "gravity"},
                                                           {surface, "surface loss"}}};
  return std::min_element(all.begin(), all.end())->second;
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/terms/surface.hpp"

namespace meltproof::solver {

/// A Gaussian beam moving along x.
struct Laser {
  double power = 0;     ///< P, W
  double radius = 0;    ///< 1/e2 radius, m; D4sigma = 2 radius for a Gaussian beam
  double speed = 0;     ///< m s-1
  double start_x = 0;   ///< m, where the beam is at time 0
  double y = 0;         ///< m
  double exposure = 0;  ///< s, the beam is on from 0 to here

  double x(double time) const { return start_x + speed * time; }
  bool on(double time) const { return time < exposure; }
};

/// Where the beam's power went, W. The three add up to the beam's power.
struct LaserBudget {
  double absorbed = 0, reflected = 0, missed = 0;
};

/// **Laser**: I = 2 P/(pi r^2) exp(-2 s^2/r^2), integrated exactly over each column (error
/// functions) out to three radii and normalised to P; a column gives the share a(C) to its topmost
/// particle, reflects the rest, and misses if it holds no metal or lies outside the domain.
/// @param absorptivity per particle, 1; @param power per particle in W, added to.
LaserBudget irradiate(const Laser& laser, double time, const SurfaceColumns& columns,
                      const std::vector<double>& absorptivity, std::vector<double>& power);

}  // namespace meltproof::solver

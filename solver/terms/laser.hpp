// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "solver/terms/surface.hpp"

namespace meltproof::solver {

/// A Gaussian beam moving along x. Its axis meets the plane z = 0 at (x(time), y).
struct Laser {
  double power = 0;      ///< P, W
  double radius = 0;     ///< 1/e2 radius, m; D4sigma = 2 radius for a Gaussian beam
  double speed = 0;      ///< m s-1
  double start_x = 0;    ///< m, where the beam is at time 0
  double y = 0;          ///< m
  double exposure = 0;   ///< s, the beam is on from 0 to here
  double incidence = 0;  ///< rad, angle between the beam and the downward vertical, at most pi/4
  double azimuth = 0;    ///< rad, of the beam's horizontal direction of travel, from x towards y
  bool reflections = false;  ///< follow what the metal reflects, see reflection.hpp

  double x(double time) const { return start_x + speed * time; }
  bool on(double time) const { return time < exposure; }
  /// Of the columns that find_surface() must follow.
  Slant slant() const {
    return {std::tan(incidence) * std::cos(azimuth), std::tan(incidence) * std::sin(azimuth)};
  }
};

/// Where the beam's power went, W. The three add up to the beam's power.
struct LaserBudget {
  double absorbed = 0, reflected = 0, missed = 0;
};

/// Light of one column where it first met metal.
struct FirstHit {
  std::uint32_t particle = 0;
  double x = 0, y = 0;   ///< m, where the column's axis meets the plane z = 0
  double reflected = 0;  ///< W
};

/// **Laser**: I = 2 P/(pi r^2) exp(-2 s^2/r^2), s from the beam's axis, out to three radii and
/// normalised to P. A vertical beam is integrated exactly over each column (error functions); an
/// inclined one has an elliptic footprint on z = 0, r/cos(incidence) long, integrated over each
/// column by 3 x 3 Gauss points. A column gives the share a(C) to the first particle that it meets,
/// reflects the rest, and misses if it holds no metal or lies outside the domain. Absorptivity does
/// not depend on the angle, and reflected light is not followed; see reflection.hpp for that.
/// @param absorptivity of a particle, 1; @param power per particle in W, added to; @param ranks
/// that share the columns, whose budget comes back everywhere (collectively); @param hits if not
/// null, filled with the columns that met a particle of this rank.
LaserBudget irradiate(const Laser& laser, double time, const SurfaceColumns& columns,
                      const std::function<double(std::uint32_t)>& absorptivity,
                      std::vector<double>& power, const Ranks& ranks = {},
                      std::vector<FirstHit>* hits = nullptr);

}  // namespace meltproof::solver

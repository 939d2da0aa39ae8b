// SPDX-License-Identifier: GPL-3.0-or-later
// Every criterion of the time step, so that a run can say which one held it back.
#pragma once

#include <limits>
#include <string>

namespace meltproof::solver {

/// Extremes over the particles from which the criteria follow. Zero switches a criterion off.
struct StepExtremes {
  double smoothing_length = 0;     ///< h, m
  double sound_speed = 0;          ///< c, m s-1; zero while particles are fixed
  double courant = 0.25;           ///< C of the acoustic limit
  double speed = 0;                ///< largest |v|, m s-1
  double kinematic_viscosity = 0;  ///< largest nu, m2 s-1
  double surface_tension = 0;      ///< largest sigma, N m-1
  double density = 0;              ///< smallest rho, kg m-3
  double thermal_diffusivity = 0;  ///< largest k/(rho c_p), m2 s-1
  double species_diffusivity = 0;  ///< largest D, m2 s-1
  double gravity = 0;              ///< g, m s-2
  double surface_rate = 0;         ///< fastest d(loss)/dT / (m c_p) of a surface particle, 1/s
};

/// The largest allowed step of each criterion, s; infinite where it does not apply.
struct StepLimits {
  double acoustic = std::numeric_limits<double>::infinity();   ///< C h/(c + |v|)
  double viscous = std::numeric_limits<double>::infinity();    ///< 0.125 h^2/nu
  double capillary = std::numeric_limits<double>::infinity();  ///< 0.25 sqrt(rho h^3/(2 pi sigma))
  double thermal = std::numeric_limits<double>::infinity();    ///< 0.125 h^2 rho c_p/k
  double species = std::numeric_limits<double>::infinity();    ///< 0.125 h^2/D (the paper's Eq. 5)
  double gravity = std::numeric_limits<double>::infinity();    ///< 0.25 sqrt(h/g)

  double surface = std::numeric_limits<double>::infinity();  ///< 0.5 m c_p / (d(loss)/dT)

  double smallest() const;
  std::string smallest_name() const;
};

/// The criteria of Morris et al. (1997) and the paper's Eq. 5, where C is 0.25; the last one keeps
/// an evaporating particle from cooling by more than half of its way back to balance in one step.
StepLimits step_limits(const StepExtremes& extremes);

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "base/material.hpp"
#include "solver/terms/surface.hpp"

namespace meltproof::solver {

/// What the surface gives off.
struct SurfaceLossSettings {
  bool evaporation = true, radiation = true;
  double ambient_temperature = 293.15;  ///< K
  double ambient_pressure = 101325;     ///< Pa, at which boiling() is the boiling temperature
};

/// Power lost through the surface, W.
struct SurfaceLossBudget {
  double evaporation = 0, radiation = 0;
  double fastest_rate =
      0;  ///< largest d(loss)/dT over m c_p of a particle, 1/s, if all its columns are open
};

/// **Evaporation**: m' = c_s p_sat sqrt(M/(2 pi R T)) with p_sat = p_a exp[L_v M/R (1/T_b - 1/T)];
/// the heat taken is m' L_v. c_s = 0.82 is the sticking share that Khairallah et al. (2016) apply
/// to the evaporated flux; it is applied here once and is not part of any recoil pressure. Returns
/// W m-2. The mass lost is not removed from the particles in this version. It is not small: without
/// recoil and flow half of the absorbed power evaporates, at 10 um spacing the mass of half the
/// molten track (evaporated energy over L_v against a half-elliptic track of its width and depth).
double evaporation_flux(double temperature, double concentration, const Mixture& mixture,
                        double ambient_pressure);

/// **Radiation**: emissivity sigma (T^4 - T_a^4), W m-2.
double radiation_flux(double temperature, double emissivity, double ambient_temperature);

/// Takes both from the topmost particle of every column, each column with its plan area.
/// @param power per particle in W, subtracted from.
SurfaceLossBudget lose_heat(const Particles& particles, const SurfaceColumns& columns,
                            const Mixture& mixture, const SurfaceLossSettings& settings,
                            std::vector<double>& power);

}  // namespace meltproof::solver

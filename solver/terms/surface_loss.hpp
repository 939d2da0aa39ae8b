// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "base/material.hpp"
#include "solver/terms/surface.hpp"

namespace meltproof::solver {

/// What the energy that a vapour leaves with is made of.
enum class VapourHeat {
  latent,  ///< m' L_v: the particle keeps its mass, so its specific enthalpy falls by what leaving
           ///< mass would take beyond its own share; this is what a particle of constant mass needs
  latent_and_sensible  ///< m' (L_v + h(T) - h(T_ref)): the energy that crosses a fixed surface
};

/// What the surface gives off.
struct SurfaceLossSettings {
  bool evaporation = true, radiation = true;
  double ambient_temperature = 293.15;   ///< K
  double ambient_pressure = 101325;      ///< Pa, at which boiling() is the boiling temperature
  double heat_transfer_coefficient = 0;  ///< h_c of convection, W m-2 K-1; 0: none, as in the paper
  VapourHeat vapour_heat = VapourHeat::latent;
};

/// Power lost through the surface, W.
struct SurfaceLossBudget {
  double evaporation = 0, radiation = 0, convection = 0;
  double mass_rate = 0;  ///< vapour that leaves, kg s-1; the particles keep it in this version
  double fastest_rate =
      0;  ///< largest d(loss)/dT over m c_p of a particle, 1/s, if all its columns are open
};

/// **Saturation pressure**: p_sat = p_a exp[L_v M/R (1/T_b - 1/T)], Pa (Clausius-Clapeyron, the
/// boiling temperature T_b belonging to the ambient pressure p_a). Not limited to any value.
double saturation_pressure(double temperature, double concentration, const Mixture& mixture,
                           double ambient_pressure);

/// **Recoil pressure**: p_r = 0.54 p_sat, Pa, on the liquid along the inward normal. (Anisimov
/// 1968; Knight 1979) The two factors of a strongly evaporating surface belong together and each
/// acts on p_sat once: 18 % of the vapour condenses again behind the Knudsen layer, which leaves
/// 0.82 of the mass flux (evaporation_mass_flux) and 0.54 of the pressure (here). Neither is
/// applied to the other's result.
double recoil_pressure(double temperature, double concentration, const Mixture& mixture,
                       double ambient_pressure);

/// **Evaporation**: m' = c_s p_sat sqrt(M/(2 pi R T)), kg m-2 s-1, with the full p_sat and the
/// material's sticking share c_s = 0.82. (Khairallah et al. 2016)
double evaporation_mass_flux(double temperature, double concentration, const Mixture& mixture,
                             double ambient_pressure);

/// The heat that evaporation_mass_flux() takes, W m-2: m' L_v, or with the vapour's sensible heat
/// above the reference temperature of the enthalpy (298.15 K). It is not small: without recoil and
/// flow half of the absorbed power evaporates, at 10 um spacing the mass of half the molten track
/// (evaporated energy over L_v against a half-elliptic track of its width and depth).
double evaporation_flux(double temperature, double concentration, const Mixture& mixture,
                        double ambient_pressure, VapourHeat heat = VapourHeat::latent);

/// **Radiation**: emissivity sigma (T^4 - T_a^4), W m-2.
double radiation_flux(double temperature, double emissivity, double ambient_temperature);

/// Takes all of it from the topmost particle of every column, each column with its plan area.
/// @param power per particle in W, subtracted from; @param ranks that share the particles: the sums
/// of the budget are those of all (collectively), the fastest rate is this rank's.
SurfaceLossBudget lose_heat(const Particles& particles, const SurfaceColumns& columns,
                            const Mixture& mixture, const SurfaceLossSettings& settings,
                            std::vector<double>& power, const Ranks& ranks = {});

/// What a particle gives off heat through.
struct ExposedArea {
  std::uint32_t particle = 0;
  double area = 0;  ///< m2
};

/// The same through the surface that each particle itself stands for, seen from above or not.
/// @param areas of this rank's particles that have any.
SurfaceLossBudget lose_heat(const Particles& particles, const std::vector<ExposedArea>& areas,
                            const Mixture& mixture, const SurfaceLossSettings& settings,
                            std::vector<double>& power, const Ranks& ranks = {});

}  // namespace meltproof::solver

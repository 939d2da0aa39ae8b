// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/case/flow_input.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"
#include "solver/terms/surface_loss.hpp"

namespace meltproof::solver {

InputTable flow_table(FlowInput& f) {
  FlowSettings& s = f.settings;
  InputTable table("flow", "How the melt moves; solid metal stands still.");
  table
      .flag(f.enabled,
            {.name = "enabled", .about = "Let the melt flow; false: heat and species alone."})
      .text(f.surroundings, {.name = "surroundings",
                             .about = "What is not metal: nothing at all (a free surface), or gas "
                                      "particles in the closed multi-phase form of the paper.",
                             .choices = {"free", "gas"}})
      .quantity(f.gas.density_ratio, {.name = "gas_density_ratio",
                                      .unit = "1",
                                      .about = "Metal over gas; steps shrink with its square root.",
                                      .minimum = 1,
                                      .maximum = 10000})
      .quantity(f.gas.viscosity,
                {.name = "gas_viscosity", .unit = "Pa s", .about = "Of the gas.", .minimum = 0})
      .quantity(f.gas.height, {.name = "gas_height",
                               .unit = "m",
                               .about = "Of the gas above the highest metal.",
                               .minimum = 1e-6,
                               .maximum = 1e-2})
      .quantity(s.sound_speed,
                {.name = "sound_speed",
                 .unit = "m s-1",
                 .about = "Of the weakly compressible melt: p = c^2 (rho - rho0). Ten times the "
                          "flow's speed, and high enough for the pressures that act.",
                 .minimum = 1,
                 .maximum = 5000})
      .quantity(
          s.courant,
          {.name = "courant",
           .unit = "1",
           .about = "Of the acoustic step C h/(c + |v|); 0.25 is the paper's (Eq. 5), with 0.4 "
                    "nothing of the verification cases changes (solver/flow/README.md).",
           .minimum = 0.01,
           .maximum = 0.7})
      .quantity(f.smallest_drop, {.name = "smallest_drop",
                                  .unit = "m",
                                  .about = "Radius of a drop whose capillary pressure may compress "
                                           "the melt by 1 %; sets the least sound speed.",
                                  .minimum = 1e-7,
                                  .maximum = 1e-3})
      .quantity(s.viscosity_factor,
                {.name = "viscosity_factor",
                 .unit = "1",
                 .about = "On the real viscosity; 20 is the paper's (note of Table A2, errata 12).",
                 .minimum = 0,
                 .maximum = 1000})
      .quantity(s.artificial_viscosity,
                {.name = "artificial_viscosity",
                 .unit = "1",
                 .about = "Monaghan's alpha; a real viscosity (factor 1) needs 0.1 to 0.2.",
                 .minimum = 0,
                 .maximum = 10})
      .quantity(s.density_diffusion, {.name = "density_diffusion",
                                      .unit = "1",
                                      .about = "delta of Molteni and Colagrossi.",
                                      .minimum = 0,
                                      .maximum = 1})
      .quantity(
          s.density_relaxation,
          {.name = "density_relaxation",
           .unit = "1",
           .about = "N: densities go to the sum over the particles, at the surface over its part "
                    "within the metal, within N smoothing lengths' travel of sound; 0: never.",
           .minimum = 0,
           .maximum = 1e6})
      .text(f.diffusion_form,
            {.name = "density_diffusion_form",
             .about = "plain: flattens pressure profiles too, and the melt sinks in; corrected: "
                      "leaves a linear profile alone (after Antuono et al. 2010).",
             .choices = {"plain", "corrected"}})
      .text(f.cure, {.name = "clumping_cure",
                     .about = "What keeps particles of the surface apart under tension.",
                     .choices = {"none", "repulsion", "transport"}})
      .quantity(s.repulsion, {.name = "repulsion",
                              .unit = "Pa",
                              .about = "Strength k of the cure \"repulsion\".",
                              .minimum = 0,
                              .maximum = 1e7})
      .quantity(s.repulsion_distance, {.name = "repulsion_distance",
                                       .unit = "1",
                                       .about = "Below which it acts, in spacings.",
                                       .minimum = 0.3,
                                       .maximum = 1})
      .quantity(s.transport_pressure, {.name = "transport_pressure",
                                       .unit = "Pa",
                                       .about = "Background pressure of the cure \"transport\".",
                                       .minimum = 0,
                                       .maximum = 1e9})
      .quantity(s.shifting,
                {.name = "shifting",
                 .unit = "1",
                 .about = "Transport velocity below the surface, background pressure over rho c h "
                          "|grad v|: relaxes the arrangement of particles that shear loads; 0: "
                          "none, then a stirred melt is some 15 % too stiff.",
                 .minimum = 0,
                 .maximum = 100})
      .flag(s.surface_tension, {.name = "surface_tension", .about = "Capillary pressure."})
      .flag(s.marangoni, {.name = "marangoni",
                          .about = "Pull along the surface by the gradient of surface tension, of "
                                   "temperature and of composition."})
      .flag(s.recoil, {.name = "recoil", .about = "Recoil pressure of the vapour."})
      .quantity(f.freezing_fraction,
                {.name = "freezing_fraction",
                 .unit = "1",
                 .about = "Liquid fraction below which melt becomes wall; melting needs 1.",
                 .minimum = 0.5,
                 .maximum = 1})
      .whole(f.steps, {.name = "steps_per_thermal_step",
                       .about = "Acoustic steps in a thermal one, at most.",
                       .minimum = 1,
                       .maximum = 1000})
      .flag(
          f.two_paces,
          {.name = "heat_in_two_paces",
           .about = "Metal far from the melt conducts heat in steps as long as conduction allows; "
                    "where heat holds the steps back, what conducts best does so in parts of one."})
      .quantity(s.skin, {.name = "skin",
                         .unit = "1",
                         .about = "Skin of the Verlet lists, in spacings.",
                         .minimum = 0.05,
                         .maximum = 2});
  return table;
}

std::optional<FlowSettings> flow_settings(const FlowInput& f, double viscosity_includes) {
  if (!f.enabled) {
    return std::nullopt;
  }
  FlowSettings settings = f.settings;
  settings.viscosity_factor /= viscosity_includes;
  settings.diffusion_form =
      f.diffusion_form == "plain" ? DensityDiffusion::plain : DensityDiffusion::corrected;
  settings.cure = f.cure == "none"        ? ClumpingCure::none
                  : f.cure == "transport" ? ClumpingCure::transport
                                          : ClumpingCure::repulsion;
  return settings;
}

std::vector<std::string> flow_warnings(const FlowInput& f, const Mixture& mixture) {
  std::vector<std::string> result;
  if (!f.enabled) {
    return result;
  }
  const double tension = mixture.surface_tension(mixture.liquidus(0), 0);
  const double density = mixture.density(0);
  const double capillary = 2 * tension / f.smallest_drop;
  // The surface under a beam settles some 500 K above boiling, where recoil holds it.
  const double recoil = f.settings.recoil ? recoil_pressure(mixture.boiling(0) + 500, 0, mixture,
                                                            SurfaceLossSettings{}.ambient_pressure)
                                          : 0;
  const auto compression = [&](double pressure) {
    return pressure / (density * f.settings.sound_speed * f.settings.sound_speed);
  };
  const auto speed_for = [&](double pressure, double share) {
    return std::sqrt(pressure / (density * share));
  };
  // Measured: at 25 m/s the melt under recoil is compressed by 29 %, at 50 by up to 8 %.
  const double most = std::max(capillary, recoil), refused = 0.05, warned = 0.03;
  if (compression(most) > refused) {
    throw InputError(fmt::format(
        "flow.sound_speed = {:.4g} m/s: a pressure of {:.3g} Pa acts ({} of the melt), which would "
        "compress it by {:.1f} %; the case cannot be stable below {:.0f} m/s, and {:.0f} m/s keeps "
        "the compression at 1 %",
        f.settings.sound_speed, most, capillary >= recoil ? "capillary pressure" : "recoil",
        100 * compression(most), speed_for(most, refused), speed_for(most, 0.01)));
  }
  if (compression(most) > warned) {
    result.push_back(fmt::format(
        "the sound speed of {:.4g} m/s lets pressures of {:.3g} Pa compress the melt by {:.1f} %; "
        "{:.0f} m/s keeps that at 1 %",
        f.settings.sound_speed, most, 100 * compression(most), speed_for(most, 0.01)));
  }
  if (f.settings.density_relaxation > 0 && f.settings.density_relaxation < 1) {
    throw InputError(
        fmt::format("flow.density_relaxation = {:.4g}: the density would go to its sum faster than "
                    "sound crosses a particle, which no step resolves; 0 (never), or 1 and more",
                    f.settings.density_relaxation));
  }
  if (f.settings.viscosity_factor < 5 && f.settings.artificial_viscosity < 0.1) {
    result.push_back(fmt::format(
        "a viscosity of {:.3g} times the real one leaves the flow under-damped at these spacings; "
        "flow.artificial_viscosity = 0.1 to 0.2 was needed",
        f.settings.viscosity_factor));
  }
  return result;
}

}  // namespace meltproof::solver

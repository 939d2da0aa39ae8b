// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/case/track_case.hpp"

#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"

namespace meltproof::solver {

Input declare(TrackCase& t) {
  InputTable root("track", "A single laser track on a plate, with or without a layer of powder.");
  root.text(t.title, {.name = "title", .about = "Shown in the report."})
      .quantity(t.spacing, {.name = "spacing",
                            .unit = "m",
                            .about = "Particle spacing; the paper uses 2 um.",
                            .required = true,
                            .minimum = 1e-7,
                            .maximum = 1e-4})
      .quantity(t.smoothing_ratio, {.name = "smoothing_ratio",
                                    .unit = "1",
                                    .about = "Smoothing length over spacing.",
                                    .minimum = 0.9,
                                    .maximum = 2})
      .quantity(
          t.initial_temperature,
          {.name = "initial_temperature",
           .unit = "K",
           .about =
               "Of plate and powder; the paper gives none (errata 16), room temperature assumed.",
           .minimum = 200,
           .maximum = 1500});

  InputTable powder("powder", "What lies on the plate.");
  powder
      .text(t.surface, {.name = "surface",
                        .about = "A layer of powder from a bed file, or the bare plate.",
                        .choices = {"powder", "bare"}})
      .file(t.bed,
            {.name = "bed", .about = "The artifact of meltproof-powder; also given by --powder."});

  InputTable materials("materials", "Property tables.");
  materials.file(t.base, {.name = "base", .about = "Plate and base powder.", .required = true})
      .file(t.additive, {.name = "additive", .about = "The alloying powder.", .required = true})
      .file(t.diffusivity_laws, {.name = "diffusivity",
                                 .about = "Laws of the additive's diffusivity in the melt.",
                                 .required = true})
      .text(t.diffusivity_law,
            {.name = "diffusivity_law", .about = "Which law; empty: the file's default."})
      .text(
          t.form,
          {.name = "form",
           .about =
               "Repaired property tables, or as the paper prints them where that can be evaluated.",
           .choices = {"repaired", "as_printed"}})
      .text(t.density,
            {.name = "density",
             .about = "One reference density as the paper's Table 3 has it, or each material's own "
                      "real_density: powder grains of AlSi10Mg then weigh a third.",
             .choices = {"uniform", "own"}})
      .quantity(t.conductivity_factor,
                {.name = "conductivity_factor",
                 .unit = "1",
                 .about = "On the base material's conductivity, for sensitivities.",
                 .minimum = 0.1,
                 .maximum = 10})
      .quantity(t.tension_slope_factor,
                {.name = "tension_slope_factor",
                 .unit = "1",
                 .about = "On the slope of the base material's surface tension with temperature, "
                          "for sensitivities; its value where the table begins stays.",
                 .minimum = -10,
                 .maximum = 10})
      .quantity(t.additive_molar_mass,
                {.name = "additive_molar_mass",
                 .unit = "kg mol-1",
                 .about = "Of the additive instead of its table's value; negative: the table's. "
                          "The paper prints 0.33214, a sum over a formula (errata 14).",
                 .minimum = -1,
                 .maximum = 1});

  InputTable laser("laser", "The beam (paper, Table 2).");
  laser
      .quantity(t.power, {.name = "power",
                          .unit = "W",
                          .about = "Power.",
                          .required = true,
                          .minimum = 0,
                          .maximum = 5000})
      .quantity(t.beam_radius, {.name = "radius",
                                .unit = "m",
                                .about = "Beam radius.",
                                .required = true,
                                .minimum = 1e-6,
                                .maximum = 1e-3})
      .text(t.absorption,
            {.name = "absorption",
             .about = "constant: what the metal first meets absorbs its share, the rest is gone. "
                      "ray_traced: reflected light is followed, so that a depression absorbs more "
                      "(errata 19).",
             .choices = {"constant", "ray_traced"}})
      .text(t.radius_definition, {.name = "radius_definition",
                                  .about = "What the radius means; for a Gaussian beam both are "
                                           "the same length. The paper does not say (errata 16).",
                                  .choices = {"1/e2", "D4sigma/2"}})
      .quantity(t.speed, {.name = "speed",
                          .unit = "m s-1",
                          .about = "Scan speed.",
                          .required = true,
                          .minimum = 1e-3,
                          .maximum = 20})
      .quantity(t.exposure, {.name = "exposure",
                             .unit = "s",
                             .about = "How long the beam is on (paper, Table 3).",
                             .required = true,
                             .minimum = 1e-6,
                             .maximum = 1})
      .quantity(
          t.absorptivity,
          {.name = "absorptivity",
           .unit = "1",
           .about = "Of the base material instead of its table's value; negative: the table's.",
           .minimum = -1,
           .maximum = 1})
      .quantity(t.incidence_angle,
                {.name = "incidence_angle",
                 .unit = "rad",
                 .about = "Between the beam and the vertical, as \"20 degree\"; its footprint is "
                          "an ellipse.",
                 .minimum = 0,
                 .maximum = 0.7854})
      .quantity(t.incidence_azimuth,
                {.name = "incidence_azimuth",
                 .unit = "rad",
                 .about = "Horizontal direction in which an inclined beam travels, from the scan's "
                          "direction towards y.",
                 .minimum = -6.2832,
                 .maximum = 6.2832});

  InputTable domain("domain", "The box around the track; its faces let nothing through.");
  domain
      .quantity(t.before, {.name = "before",
                           .unit = "m",
                           .about = "Plate before the start of the track.",
                           .minimum = 0})
      .quantity(t.behind, {.name = "behind",
                           .unit = "m",
                           .about = "Plate behind the end of the track.",
                           .minimum = 0})
      .quantity(t.width,
                {.name = "width", .unit = "m", .about = "Across the track.", .minimum = 1e-5})
      .quantity(t.depth, {.name = "depth", .unit = "m", .about = "Of the plate.", .minimum = 1e-5});

  InputTable physics("physics", "Which terms act, and in which form.");
  physics.flag(t.species, {.name = "species", .about = "Alloy diffusion in the liquid (Eq. 1)."})
      .text(t.species_factor,
            {.name = "species_factor",
             .about = "Eq. 2 with the consistent factor 2, or 4 as printed (errata 1).",
             .choices = {"consistent", "as_printed"}})
      .text(t.species_operator, {.name = "species_operator",
                                 .about = "Which moments of the species operator are exact on the "
                                          "lattice; none is the plain form of Cleary and Monaghan.",
                                 .choices = {"none", "second", "fourth"}})
      .text(t.species_scheme,
            {.name = "species_scheme",
             .about = "Eqs. 3-4 as printed, first order in time but below the error in space "
                      "(errata 5), or a midpoint step of second order.",
             .choices = {"midpoint", "as_printed"}})
      .flag(t.surface_conduction,
            {.name = "surface_conduction",
             .about = "Restores the conduction along free surfaces, where a particle lacks the "
                      "neighbours outside; verified on a plate at rest (moving_source)."})
      .flag(t.evaporation, {.name = "evaporation", .about = "Heat taken by evaporation."})
      .flag(t.radiation, {.name = "radiation", .about = "Heat lost by radiation."})
      .quantity(t.ambient_temperature, {.name = "ambient_temperature",
                                        .unit = "K",
                                        .about = "Of the surroundings.",
                                        .minimum = 0})
      .quantity(t.ambient_pressure, {.name = "ambient_pressure",
                                     .unit = "Pa",
                                     .about = "At which the boiling temperature holds.",
                                     .minimum = 1})
      .text(
          t.vapour_heat,
          {.name = "vapour_heat",
           .about = "What leaves with the vapour: the latent heat, since the particles keep their "
                    "mass, or also its sensible heat above 298.15 K.",
           .choices = {"latent", "latent_and_sensible"}})
      .quantity(t.heat_transfer_coefficient,
                {.name = "heat_transfer_coefficient",
                 .unit = "W m-2 K-1",
                 .about = "Of convection to the gas; the paper has none, some 10 to 100 are usual "
                          "and small beside radiation.",
                 .minimum = 0});

  InputTable output("output", "What is written, and when.");
  output
      .quantity(
          t.pool_temperature,
          {.name = "pool_temperature",
           .unit = "K",
           .about = "The isotherm that outlines the melt pool, as a measurement defines it; 0: "
                    "the liquidus of the base material. The fusion zone keeps the liquidus.",
           .minimum = 0,
           .maximum = 6000})
      .quantity(t.frame_rate,
                {.name = "frame_rate",
                 .unit = "Hz",
                 .about = "Snapshots a second while the beam is on: the camera's frame rate.",
                 .minimum = 1})
      .quantity(t.history_interval, {.name = "history_interval",
                                     .unit = "s",
                                     .about = "Between lines of history.csv.",
                                     .minimum = 1e-9})
      .quantity(t.averaging_window,
                {.name = "averaging_window",
                 .unit = "s",
                 .about = "Before the beam goes off, over which the pool is averaged.",
                 .minimum = 0})
      .quantity(t.cooling_limit,
                {.name = "cooling_limit",
                 .unit = "s",
                 .about = "The run ends when all is solid, at the latest this long after the beam.",
                 .minimum = 0});

  root.table(std::move(powder))
      .table(std::move(materials))
      .table(std::move(laser))
      .table(std::move(domain))
      .table(std::move(physics))
      .table(flow_table(t.flow))
      .table(std::move(output));
  return Input(std::move(root));
}

std::vector<std::string> warnings(const TrackCase& t, const Mixture& mixture) {
  std::vector<std::string> result = flow_warnings(t.flow, mixture);
  if (t.beam_radius < 2 * t.spacing) {
    throw InputError(
        fmt::format("spacing {} um: a beam radius of {} um needs a spacing of at most {} um",
                    1e6 * t.spacing, 1e6 * t.beam_radius, 5e5 * t.beam_radius));
  }
  if (t.beam_radius < 4 * t.spacing) {
    result.push_back(fmt::format(
        "the beam radius of {:.3g} um spans only {:.2g} spacings; {:.3g} um would resolve it",
        1e6 * t.beam_radius, t.beam_radius / t.spacing, 2.5e5 * t.beam_radius));
  }
  const double heated = 3 * std::sqrt(4 * 5.5e-6 * t.exposure);
  if (t.depth < heated) {
    result.push_back(fmt::format(
        "heat reaches some {:.0f} um within the exposure, the plate is {:.0f} um deep: its "
        "bottom face may be felt",
        1e6 * heated, 1e6 * t.depth));
  }
  return result;
}

Model make_model(const TrackCase& t, const Domain& domain) {
  Model model;
  model.domain = domain;
  model.smoothing_ratio = t.smoothing_ratio;
  model.species = t.species;
  model.surface_conduction = t.surface_conduction;
  model.species_factor =
      t.species_factor == "as_printed" ? SpeciesFactor::as_printed : SpeciesFactor::consistent;
  model.species_scheme =
      t.species_scheme == "as_printed" ? SpeciesScheme::as_printed : SpeciesScheme::midpoint;
  model.species_moments = t.species_operator == "none"     ? LatticeMoments::none
                          : t.species_operator == "second" ? LatticeMoments::second
                                                           : LatticeMoments::fourth;
  // For a Gaussian beam D4sigma is the 1/e2 diameter, so both definitions give the same radius.
  model.laser = Laser{.power = t.power,
                      .radius = t.beam_radius,
                      .speed = t.speed,
                      .start_x = 0,
                      .y = 0,
                      .exposure = t.exposure,
                      .incidence = t.incidence_angle,
                      .azimuth = t.incidence_azimuth,
                      .reflections = t.absorption == "ray_traced"};
  model.surface_loss = SurfaceLossSettings{.evaporation = t.evaporation,
                                           .radiation = t.radiation,
                                           .ambient_temperature = t.ambient_temperature,
                                           .ambient_pressure = t.ambient_pressure,
                                           .heat_transfer_coefficient = t.heat_transfer_coefficient,
                                           .vapour_heat = t.vapour_heat == "latent"
                                                              ? VapourHeat::latent
                                                              : VapourHeat::latent_and_sensible};
  model.flow = flow_settings(t.flow, t.form == "as_printed" ? 20 : 1);
  if (t.flow.enabled && t.flow.surroundings == "gas") {
    model.gas = t.flow.gas;
  }
  model.flow_steps = static_cast<int>(t.flow.steps);
  model.multirate = t.flow.two_paces;
  // Heat that has warmed nothing by a thousandth of a kelvin is not felt.
  model.sleep_below = 1e-3;
  model.freezing_fraction = t.flow.freezing_fraction;
  return model;
}

}  // namespace meltproof::solver

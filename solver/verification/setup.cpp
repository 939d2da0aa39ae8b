// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/verification/setup.hpp"

#include <cmath>

namespace meltproof::solver {

Property constant_property(double value, const std::string& unit) {
  return {.unit = unit,
          .source = "verification case",
          .note = "",
          .pieces = {{.from = 0, .to = 1e6, .constant = value}},
          .floor = 0};
}

Material plain_material(const std::string& name, double conductivity, double solidus,
                        double liquidus) {
  constexpr double reference = 298.15, heat = PlainMatter::specific_heat;
  Material m;
  m.name = name;
  m.solidus = solidus;
  m.liquidus = liquidus;
  m.boiling = 1e6;
  m.density = PlainMatter::density;
  m.molar_mass = 0.05;
  m.latent_heat_vaporisation = 1e6;
  m.enthalpy = {{0, reference, 1000}, {-reference * heat, 0, (1000 - reference) * heat}};
  m.conductivity = constant_property(conductivity, "W m-1 K-1");
  m.viscosity = constant_property(1e-3, "Pa s");
  m.surface_tension = constant_property(1, "N m-1");
  return m;
}

Diffusivity constant_diffusivity(double value) {
  Diffusivity law;
  law.prefactor = value;
  return law;
}

Particles make_row(std::size_t n, double spacing, std::size_t axis) {
  Particles row;
  row.spacing = spacing;
  const double volume = spacing * spacing * spacing;
  for (std::size_t i = 0; i < n; ++i) {
    Vector at{spacing / 2, spacing / 2, spacing / 2};
    at[axis] = (static_cast<double>(i) + 0.5) * spacing;
    row.add(static_cast<std::int64_t>(i), at, PlainMatter::density * volume, volume, 0, 0,
            Origin::plate);
  }
  return row;
}

Particles make_stripe(const VerificationCase& c, double spacing) {
  const double volume = spacing * spacing;
  const double enthalpy = PlainMatter::specific_heat * (300 - 298.15);
  Particles particles;
  particles.dimensions = 2;
  particles.spacing = spacing;
  const std::size_t nz = particles_along(c, c.length, spacing),
                    nx = particles_along(c, c.width, spacing);
  for (std::size_t k = 0; k < nz; ++k) {
    for (std::size_t i = 0; i < nx; ++i) {
      const double low = static_cast<double>(k) * spacing, high = low + spacing;
      const double share = std::max(0.0, std::min(high, c.z2) - std::max(low, c.z1)) / spacing;
      particles.add(static_cast<std::int64_t>(k * nx + i),
                    {(static_cast<double>(i) + 0.5) * spacing, low + spacing / 2, 0},
                    PlainMatter::density * volume, volume, enthalpy, share, Origin::plate);
    }
  }
  return particles;
}

void set_species(Model& model, const VerificationCase& c) {
  model.conduction = false;
  model.species_scheme =
      c.scheme == "as_printed" ? SpeciesScheme::as_printed : SpeciesScheme::midpoint;
  model.species_factor =
      c.factor == "as_printed" ? SpeciesFactor::as_printed : SpeciesFactor::consistent;
  model.species_moments = c.species_operator == "none"     ? LatticeMoments::none
                          : c.species_operator == "second" ? LatticeMoments::second
                                                           : LatticeMoments::fourth;
}

Domain row_domain(double length, double spacing, Face lower, Face upper, std::size_t axis) {
  Domain domain;
  domain.upper = {spacing, spacing, spacing};
  domain.upper[axis] = length;
  for (std::size_t d = 0; d < 3; ++d) {
    domain.face[d] = {Face::periodic, Face::periodic};
  }
  domain.face[axis] = {lower, upper};
  return domain;
}

void run_until(Engine& engine, double time) {
  while (engine.time() < time) {
    engine.step(time);
  }
}

VerificationRun thermal_run(const Engine& engine) {
  VerificationRun run;
  run.steps = engine.steps();
  run.particles = engine.particles().size();
  run.value_name = "temperature";
  run.value_unit = "K";
  return run;
}

double l2_error(const VerificationRun& run, double offset) {
  double difference = 0, reference = 0;
  for (std::size_t i = 0; i < run.value.size(); ++i) {
    difference += std::pow(run.value[i] - run.exact[i], 2);
    reference += std::pow(run.exact[i] - offset, 2);
  }
  return std::sqrt(difference / reference);
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// What the thermal problems are built of: materials of constant properties, rows of particles,
// norms.
#pragma once

#include <string>

#include "base/material.hpp"
#include "solver/particles/particles.hpp"
#include "solver/step/engine.hpp"
#include "solver/verification/case.hpp"

namespace meltproof::solver {

/// Every number that a dimensionless problem does not care about is a round one.
struct PlainMatter {
  static constexpr double density = 1000;        ///< kg m-3
  static constexpr double specific_heat = 1000;  ///< J kg-1 K-1
};

/// A property of one value.
Property constant_property(double value, const std::string& unit);

/// A material of constant properties without latent heat. The liquidus decides whether it is melt:
/// below all temperatures for species, above for pure conduction.
Material plain_material(const std::string& name, double conductivity, double solidus,
                        double liquidus);

/// D of one value.
Diffusivity constant_diffusivity(double value);

/// A row of n particles along `axis`, periodic across: the sums are those of three dimensions.
Particles make_row(std::size_t n, double spacing, std::size_t axis = 0);

/// A sheet of `width` by `length` (x, y) in two dimensions at 300 K, additive within z1 < y < z2.
/// A particle that the edge of the stripe cuts holds its share, so the solute's mass is exact.
Particles make_stripe(const VerificationCase& c, double spacing);

/// Scheme, factor and operator of the additive as the case says.
void set_species(Model& model, const VerificationCase& c);

/// The domain of such a row from 0 to `length`.
Domain row_domain(double length, double spacing, Face lower, Face upper, std::size_t axis = 0);

/// Steps until the engine's clock is at `time`.
void run_until(Engine& engine, double time);

/// A run with the engine's counts, whose profile is a temperature.
VerificationRun thermal_run(const Engine& engine);

/// L2 norm of value - exact over that of exact - offset.
double l2_error(const VerificationRun& run, double offset = 0);

}  // namespace meltproof::solver

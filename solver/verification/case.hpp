// SPDX-License-Identifier: GPL-3.0-or-later
// A verification case: its declared parameters, one run per spacing, and the error against the
// exact solution with the observed order. What a kind of case computes is in kinds.hpp.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/input.hpp"

namespace meltproof::solver {

/// What a case's folder says in case.toml. A kind reads the numbers that it needs; the description
/// of its run function says which.
struct VerificationCase {
  std::string name;  ///< of the folder
  std::string kind, title, reference, quantity;
  double asked = 0.01;
  std::vector<double> spacings;  ///< m, finest first
  bool long_running = false;     ///< `long` in the file: over 30 s, run only by --long

  // Geometry, m.
  double length = 100e-6, width = 40e-6, height = 40e-6, radius = 20e-6;
  double z1 = 44e-6, z2 = 55e-6;
  long long dimensions = 3;

  // Time.
  double time = 1;      ///< s; stefan: follows from `front`
  long long steps = 0;  ///< 0: until `time`

  // Heat and species.
  double diffusivity = 1e-12;  ///< m2 s-1
  double conductivity = 25;    ///< W m-1 K-1
  double temperature = 600;    ///< K
  double stefan = 0.5;
  double superheat = 0.5;
  double front = 0.6;  ///< of the length
  double conductivity_ratio = 10;
  double power = 100;  ///< W
  double absorptivity = 0.4;
  double incidence_angle = 0;  ///< rad
  std::string scheme = "as_printed", factor = "consistent", species_operator = "fourth";
  std::string variant;

  // Flow.
  double reynolds = 100;
  double speed = 1;         ///< m s-1
  double sound_speed = 0;   ///< m s-1; 0: ten times the largest speed
  double density = 1000;    ///< kg m-3
  double viscosity = 1e-3;  ///< Pa s
  double density_ratio = 1, viscosity_ratio = 1;
  double surface_tension = 0;        ///< N m-1
  double surface_tension_slope = 0;  ///< N m-1 K-1
  double temperature_gradient = 0;   ///< K m-1
  double gravity = 0;                ///< m s-2
  double pressure = 0;               ///< Pa
};

/// The declaration; `c` must outlive the input.
Input declare(VerificationCase& c);

/// What one run returns: the error, a profile to draw, and whatever else is worth reporting.
struct VerificationRun {
  double spacing = 0, error = 0;
  std::size_t steps = 0, particles = 0;
  std::vector<double> position, value, exact;  ///< the profile; position in SI
  /// What the profile's columns are called in figures, and their units.
  std::string position_name = "position", position_unit = "um";
  std::string value_name = "value", value_unit = "1";
  double position_scale = 1e6;  ///< from SI to position_unit
  /// Further results as name: number with unit in the name, e.g. {"parasitic_capillary_number":
  /// 1e-4}.
  nlohmann::json extra = nlohmann::json::object();
  /// Conditions beside the error that the run did not hold, one sentence each: the case fails.
  std::vector<std::string> broken = {};
};

/// Particles along a length. @throws InputError if the spacing does not divide it.
std::size_t particles_along(const VerificationCase& c, double length, double spacing);

/// Runs the case at one spacing.
VerificationRun run_case(const VerificationCase& c, double spacing);

/// Slope of ln(error) over ln(spacing) between the two finest runs.
double observed_order(const std::vector<VerificationRun>& runs);

/// All spacings: {name, kind, title, reference, quantity, error, asked, order, pass, spacings_um,
/// errors, steps, particles, extra, broken, long, profile: {position, value}}. `error`, `extra` and
/// `broken` are those of the finest spacing. A run that ends in an error is a failed case with the
/// error's sentence in `broken`. The profiles of all runs come back in `profile` as CSV.
nlohmann::json verify(const VerificationCase& c, std::string& profile);

}  // namespace meltproof::solver

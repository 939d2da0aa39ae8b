// SPDX-License-Identifier: GPL-3.0-or-later
// A verification case: its declared parameters, one run per spacing, and the error against the
// exact solution with the observed order.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/input.hpp"

namespace meltproof::solver {

/// What a case's folder says in case.toml. Which of the numbers a kind uses is said in their
/// description.
struct VerificationCase {
  std::string name;  ///< of the folder
  std::string kind, title, reference, quantity;
  double asked = 0.01;
  std::vector<double> spacings;  ///< m, finest first
  double length = 100e-6;        ///< m
  double width = 40e-6;          ///< m, species_stripe: the domain is two-dimensional
  double z1 = 44e-6, z2 = 55e-6;
  double diffusivity = 1e-12;  ///< m2 s-1
  double time = 1;             ///< s; stefan: follows from `front`
  double stefan = 0.5;
  double front = 0.6;  ///< of the length
  double conductivity_ratio = 10;
  std::string scheme = "as_printed", factor = "consistent", species_operator = "fourth";
};

/// The declaration; `c` must outlive the input.
Input declare(VerificationCase& c);

/// One run: the error and the profile along the axis.
struct VerificationRun {
  double spacing = 0, error = 0;
  std::size_t steps = 0, particles = 0;
  std::vector<double> position, value, exact;  ///< m, and the quantity
};

/// Runs the case at one spacing. @throws InputError if the spacing does not divide the domain.
VerificationRun run_case(const VerificationCase& c, double spacing);

/// Slope of ln(error) over ln(spacing) between the two finest runs.
double observed_order(const std::vector<VerificationRun>& runs);

/// All spacings: {name, title, reference, quantity, error, asked, order, pass, spacings_um, errors,
/// ...}. The profiles of all runs come back in `profile` as CSV.
nlohmann::json verify(const VerificationCase& c, std::string& profile);

}  // namespace meltproof::solver

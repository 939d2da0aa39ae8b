// SPDX-License-Identifier: GPL-3.0-or-later
// The [flow] table of a track: how the melt moves.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "base/material.hpp"
#include "solver/flow/free_surface.hpp"
#include "solver/multiphase/gas.hpp"

namespace meltproof::solver {

/// What [flow] says.
struct FlowInput {
  bool enabled = true;
  std::string surroundings = "free";  ///< "free" surface, or "gas"
  GasSettings gas;
  std::string diffusion_form = "corrected";  ///< "plain" or "corrected"
  std::string cure = "repulsion";            ///< "none", "repulsion", "transport"
  FlowSettings settings;
  long long steps = 10;          ///< acoustic steps in a thermal one, at most
  bool two_paces = true;         ///< of heat, see Model::multirate
  double smallest_drop = 20e-6;  ///< m, radius of the smallest drop whose pressure must be held
  double freezing_fraction = 0.98;
};

/// The declaration; `flow` must outlive the input.
InputTable flow_table(FlowInput& flow);

/// The settings for the engine, or none if the melt is to stand still.
/// @param viscosity_includes the factor that the material's viscosity includes already: 20 for the
/// printed forms, 1 for the repaired ones.
std::optional<FlowSettings> flow_settings(const FlowInput& flow, double viscosity_includes);

/// Sentences about what the sound speed and the spacing cannot hold well.
/// @throws InputError where the case could not be stable, with the number that would do.
std::vector<std::string> flow_warnings(const FlowInput& flow, const Mixture& mixture);

}  // namespace meltproof::solver

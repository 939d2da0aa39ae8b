// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/verification/kinds.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "solver/verification/flow_problems.hpp"
#include "solver/verification/laser_budget.hpp"
#include "solver/verification/problems.hpp"
#include "solver/verification/species_moving.hpp"
#include "solver/verification/surface_drop.hpp"
#include "solver/verification/surface_layer.hpp"
#include "solver/verification/thermal_phase.hpp"
#include "solver/verification/thermal_source.hpp"
#include "solver/verification/thermal_surface.hpp"

namespace meltproof::solver {

const std::vector<VerificationKind>& verification_kinds() {
  // One line per kind, in the order of the suite's table.
  // clang-format off
  static const std::vector<VerificationKind> kinds = {
      {"species_stripe", run_species_stripe},
      {"species_moving", run_species_moving},
      {"conduction_slab", run_conduction_slab},
      {"conduction_contact", run_conduction_contact},
      {"stefan", run_stefan},
      {"stefan_two_phase", run_stefan_two_phase},
      {"moving_source", run_moving_source},
      {"evaporative_cooling", run_evaporative_cooling},
      {"laser_budget", run_laser_budget},
      {"laplace_free", run_laplace_free},
      {"oscillating_drop", run_oscillating_drop},
      {"hydrostatic_free", run_hydrostatic_free},
      {"recoil_flat", run_recoil_flat},
      {"thermocapillary_layer", run_thermocapillary_layer},
      {"channel", run_channel},
      {"hydrostatic", run_hydrostatic},
      {"taylor_green", run_taylor_green},
      {"cavity", run_cavity},
      {"laplace_drop", run_laplace_drop},
      {"drop_migration", run_drop_migration},
  };
  // clang-format on
  return kinds;
}

const VerificationKind& find_kind(const std::string& name) {
  const auto& kinds = verification_kinds();
  const auto found = std::find_if(kinds.begin(), kinds.end(),
                                  [&](const VerificationKind& kind) { return kind.name == name; });
  if (found == kinds.end()) {
    std::vector<std::string> names;
    for (const auto& kind : kinds) {
      names.push_back(kind.name);
    }
    throw InputError(fmt::format("there is no kind of verification case \"{}\"; choose one of: {}",
                                 name, fmt::join(names, ", ")));
  }
  return *found;
}

}  // namespace meltproof::solver

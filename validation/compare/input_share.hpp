// SPDX-License-Identifier: GPL-3.0-or-later
// The share of a simulated number that is uncertain because the simulation's inputs are.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "validation/compare/sources.hpp"
#include "validation/compare/table.hpp"

namespace meltproof::validation {

/// u_input of V&V 20 as a share of S, from the sensitivities that the studies found.
struct InputShare {
  std::optional<double> relative;  ///< root of the sum of squares; absent while there is no part
  nlohmann::json parts = nlohmann::json::object();  ///< by input, as shares of S
  std::vector<std::string> missing = {};            ///< inputs that no run has evaluated yet
};

/// The share for the quantity that the row names as its `study`. An input that the row names under
/// `inputs` has the relative standard uncertainty given there, because the material or the beam of
/// this row is another one; with 0 % it does not exist here.
/// @throws InputError for an entry that is not "name = 5 %", names no input of the studies, or
/// gives
///         a choice between laws another share than 0 %.
InputShare input_share(const Row& row, const Places& places);

}  // namespace meltproof::validation

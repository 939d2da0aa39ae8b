// SPDX-License-Identifier: GPL-3.0-or-later
// The kinds of verification case. To add one: write its run function, add one line to the table in
// kinds.cpp, and make a folder with a case.toml.
#pragma once

#include <string>
#include <vector>

#include "solver/verification/case.hpp"

namespace meltproof::solver {

/// A kind of case: the name that case.toml gives, and the function that runs it at one spacing.
struct VerificationKind {
  std::string name;
  VerificationRun (*run)(const VerificationCase& c, double spacing);
};

/// Every kind there is.
const std::vector<VerificationKind>& verification_kinds();

/// @throws InputError naming the kinds that there are.
const VerificationKind& find_kind(const std::string& name);

}  // namespace meltproof::solver

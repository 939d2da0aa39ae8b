// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/verification/case.hpp"

namespace meltproof::solver {

/// Liquid steel as the tests of the free surface have it: a case without a shape.
inline VerificationCase melt_case() {
  VerificationCase c;
  c.name = "free_surface_test";
  c.density = 7763;
  c.viscosity = 0.1;
  c.surface_tension = 1.82;
  c.sound_speed = 50;
  c.temperature = 2000;
  return c;
}

}  // namespace meltproof::solver

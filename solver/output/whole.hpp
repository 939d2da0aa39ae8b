// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/step/engine.hpp"

namespace meltproof::solver {

/// **The metal of all ranks, to be looked at as a whole**, in the engine's order, on the root; none
/// elsewhere. A single rank's particles are looked at where they are. Of those of several the root
/// is sent, a field at a time, what says where metal is and was molten: identity, position, mass,
/// volume, peak temperature, phase and whether it ever melted; some 70 bytes a particle. All other
/// arrays are empty then.
class Whole {
 public:
  /// Collective. The engine must stay as it is while this is looked at.
  explicit Whole(const Engine& engine);
  const Particles& particles() const { return *particles_; }

 private:
  Particles gathered_;
  const Particles* particles_ = &gathered_;
};

}  // namespace meltproof::solver

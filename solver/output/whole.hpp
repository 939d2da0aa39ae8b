// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/step/engine.hpp"

namespace meltproof::solver {

/// **The particles of all ranks together**, in the engine's order, on the root; none elsewhere. A
/// single rank's are looked at where they are, those of several are gathered: of a run that many
/// ranks share the root must be able to hold one snapshot.
class Whole {
 public:
  /// Collective. The engine must stay as it is while this is looked at.
  explicit Whole(const Engine& engine);
  const Particles& particles() const { return *particles_; }
  /// Of the flow, Pa, per particle; empty without flow.
  const std::vector<double>& pressure() const { return pressure_; }

 private:
  Particles gathered_;
  std::vector<double> pressure_;
  const Particles* particles_ = &gathered_;
};

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// Gas around the metal: the closed multi-phase flow driven by the melt engine.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "solver/flow/free_surface.hpp"
#include "solver/multiphase/closed_flow.hpp"

namespace meltproof::solver {

/// The gas, where a case asks for it (`flow.surroundings = "gas"`).
struct GasSettings {
  double density_ratio = 20;  ///< metal over gas; the real one is some 5000
  double viscosity = 5e-4;    ///< Pa s; real argon at 1700 K has 8e-5
  double height = 100e-6;     ///< m, of the gas above the highest metal
};

/// **Metal and gas as one closed flow**: the metal's particles and a lattice of gas in every free
/// place of the box up to `height` above the metal, between mirror faces. The gas has the metal's
/// stiffness, so its sound is sqrt(density ratio) times faster and steps are as much shorter. It
/// conducts no heat and takes up no vapour.
class GasFlow {
 public:
  /// @param metal identities must be 0 to n-1; @param sound_speed of the metal, m s-1.
  GasFlow(const Particles& metal, const Domain& domain, const FlowSettings& flow,
          const GasSettings& gas);

  /// Advances by dt in as many steps as the closed flow needs: takes phases and properties from the
  /// metal, gives positions, velocities and densities back. @returns the steps taken.
  int advance(Particles& metal, const std::function<MeltProperties(std::uint32_t)>& properties,
              double dt);

  const ClosedFlow& flow() const { return flow_; }
  std::size_t gas_particles() const { return flow_.particles().size() - metal_; }

 private:
  static ClosedFlow make(const Particles& metal, const Domain& domain, const FlowSettings& flow,
                         const GasSettings& gas);

  std::size_t metal_;
  ClosedFlow flow_;
};

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// One step of the model, written as the algorithm reads. Particles are fixed in this version; flow
// adds its passes between the state and the exchange, on the same records, lists and limits.
#pragma once

#include <optional>
#include <vector>

#include "base/material.hpp"
#include "solver/particles/ghosts.hpp"
#include "solver/particles/kernel.hpp"
#include "solver/particles/neighbours.hpp"
#include "solver/step/time_step.hpp"
#include "solver/terms/conduction.hpp"
#include "solver/terms/laser.hpp"
#include "solver/terms/species.hpp"
#include "solver/terms/surface_loss.hpp"

namespace meltproof::solver {

/// How the concentration is advanced in time.
enum class SpeciesScheme {
  midpoint,    ///< C^{n+1} = C^n + dt f(C^{n+1/2}): second order
  as_printed,  ///< the paper's Eqs. 3-4, two explicit half steps: first order (paper errata 5)
};

/// What is switched on, and how.
struct Model {
  Domain domain;
  double smoothing_ratio = 1;  ///< h / spacing
  bool conduction = true;
  bool species = true;
  SpeciesFactor species_factor = SpeciesFactor::consistent;
  SpeciesScheme species_scheme = SpeciesScheme::as_printed;
  std::optional<Laser> laser;
  std::optional<SurfaceLossSettings> surface_loss;
  LatticeMoments heat_moments = LatticeMoments::second;
  LatticeMoments species_moments = LatticeMoments::fourth;
  double step_factor = 1;  ///< of the smallest limit; for studies of the order in time
};

/// Energies since the start, J.
struct EnergyLedger {
  double absorbed = 0, reflected = 0, missed = 0;  ///< of the laser's
  double evaporated = 0, radiated = 0;             ///< lost through the surface
};

/// The particles, everything derived from them, and the clock.
class Engine {
 public:
  /// Takes the particles over and puts them in space-filling order.
  Engine(Particles particles, Mixture mixture, Diffusivity diffusivity, const Model& model);

  /// Advances by the smallest limit, but not beyond `until` (s). Returns the step taken, s.
  /// @throws std::runtime_error naming particle and term if a temperature is no longer a number.
  double step(double until);

  double time() const { return time_; }
  std::size_t steps() const { return steps_; }
  const Particles& particles() const { return particles_; }
  const Mixture& mixture() const { return mixture_; }
  const Model& model() const { return model_; }
  const NeighbourList& neighbours() const { return neighbours_; }
  const StepLimits& limits() const { return limits_; }
  const EnergyLedger& ledger() const { return ledger_; }
  const QuinticSpline& kernel() const { return kernel_; }
  const LaserBudget& beam() const { return beam_; }

  double total_enthalpy() const;       ///< sum of m H, J
  double total_additive_mass() const;  ///< sum of m C, kg

 private:
  void refresh(std::size_t i);
  void refresh_ghosts();
  void check_numbers() const;
  void fill_species_records(const std::vector<double>& concentration);
  void advance_species(double dt);

  Particles particles_;
  Mixture mixture_;
  Diffusivity diffusivity_law_;
  Model model_;
  QuinticSpline kernel_, species_kernel_;
  std::vector<Ghost> ghosts_;
  NeighbourList neighbours_;
  SurfaceColumns surface_;
  std::vector<HeatRecord> heat_records_;
  std::vector<SpeciesRecord> species_records_;
  std::vector<double> thermal_diffusivity_, diffusivity_, conducted_, source_, rate_, absorptivity_,
      half_step_;
  std::vector<std::uint32_t> liquid_;
  StepLimits limits_;
  LaserBudget beam_;
  EnergyLedger ledger_;
  double time_ = 0;
  std::size_t steps_ = 0;
};

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// One step of the model, written as the algorithm reads: heat and species take one thermal step,
// then the melt flows through it in as many acoustic ones as that needs.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "base/material.hpp"
#include "solver/flow/free_surface.hpp"
#include "solver/multiphase/gas.hpp"
#include "solver/parallel/decomposition.hpp"
#include "solver/parallel/halo.hpp"
#include "solver/particles/ghosts.hpp"
#include "solver/particles/kernel.hpp"
#include "solver/particles/moving_neighbours.hpp"
#include "solver/step/engine_state.hpp"
#include "solver/step/time_step.hpp"
#include "solver/step/traveller.hpp"
#include "solver/terms/conduction.hpp"
#include "solver/terms/laser.hpp"
#include "solver/terms/species.hpp"
#include "solver/terms/surface_conduction.hpp"
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
  bool surface_conduction = false;  ///< full conduction along free surfaces
  LatticeMoments species_moments = LatticeMoments::fourth;
  double step_factor = 1;  ///< of the smallest limit; for studies of the order in time
  /// Particles that have not been warmed by more than this since the start exchange no heat among
  /// themselves, K; zero: everybody does. For a domain that begins at one temperature.
  double sleep_below = 0;
  std::optional<FlowSettings> flow;  ///< none: particles stay where they are
  /// With flow: gas around the metal, as a closed multi-phase flow; none: a free surface.
  std::optional<GasSettings> gas;
  /// With flow: acoustic steps in a thermal one, at most.
  int flow_steps = 10;
  /// With flow: metal whose temperature changes slowly conducts heat in steps as long as conduction
  /// allows, and at fine spacings what conducts best in parts of one, see exchange_heat(); false:
  /// all in every step.
  bool multirate = true;
  /// False: all neighbour lists are remade each time, those of what cannot have changed, too; for
  /// measuring what is gained.
  bool keep_lists = true;
  /// With flow: a liquid particle becomes wall below this liquid fraction; melting needs 1. The
  /// difference keeps particles at the liquidus from changing phase every step.
  double freezing_fraction = 0.98;
};

/// The particles, everything derived from them, and the clock. Several ranks share an engine: each
/// is given all of the particles, keeps those of its part of space with copies of what is near
/// them, and calls everything here that says so together with the others. Whatever their number,
/// every particle has the same bits.
class Engine {
 public:
  /// Takes the particles over and puts them in space-filling order.
  /// @throws InputError where several ranks cannot share the model: faces other than open ones, gas
  /// around the metal, conduction along surfaces.
  Engine(Particles particles, Mixture mixture, Diffusivity diffusivity, const Model& model,
         const Ranks& ranks = {});
  /// Goes on from a state of an engine with the same mixture, diffusivity and model: every later
  /// number is the one that engine would have found, on as many ranks as may be. Not with gas
  /// around the metal. @param state whole, in any order; of several ranks each gives a part of it,
  /// every particle on one of them.
  Engine(EngineState state, Mixture mixture, Diffusivity diffusivity, const Model& model,
         const Ranks& ranks = {});
  /// The present state, between two steps; of several ranks, of all on the root and of none
  /// elsewhere (collective). @throws std::logic_error with gas around the metal.
  EngineState state() const { return state(false); }
  /// The same on all ranks (collective).
  EngineState state_everywhere() const { return state(true); }
  /// What of state() is not of single particles, on all ranks (collective), and this rank's part of
  /// what is.
  EngineState state_numbers() const;
  StateView state_view() const;

  /// Advances by the smallest limit, but not beyond `until` (s). Returns the step taken, s.
  /// Collective. @throws std::runtime_error naming particle and term if a number is no longer one.
  double step(double until);

  double time() const { return time_; }
  std::size_t steps() const { return steps_; }
  const Ranks& ranks() const { return halo_->ranks(); }
  /// Those of this rank and copies of others near them, see Particles::home.
  const Particles& particles() const { return particles_; }
  const Halo& halo() const { return *halo_; }
  const Mixture& mixture() const { return mixture_; }
  const Model& model() const { return model_; }
  const PackedLists& neighbours() const { return neighbours_.list(); }
  const StepLimits& limits() const { return limits_; }
  const EnergyLedger& ledger() const { return ledger_; }
  const QuinticSpline& kernel() const { return kernel_; }
  const LaserBudget& beam() const { return beam_; }
  /// The flow; throws std::bad_optional_access if the model has none.
  const FreeSurfaceFlow& flow() const { return flow_.value(); }
  /// The gas around the metal, or none.
  const GasFlow* gas() const { return gas_ ? &*gas_ : nullptr; }
  const StepTimes& times() const { return times_; }
  std::size_t flow_steps() const { return flow_count_; }  ///< acoustic steps so far
  std::size_t list_builds() const { return list_builds_; }
  /// Particles whose conduction was summed so far, on this rank.
  std::uint64_t heat_evaluations() const { return heat_evaluations_; }
  /// What limited the flow on all ranks so far; collective.
  LimiterCounts limiters() const;
  /// What a step takes with ranks that wait for each other after each part, over what it would with
  /// all parts spread evenly, when last looked at, see Decomposition::unevenness().
  double imbalance() const { return imbalance_; }
  std::size_t lost() const { return lost_; }  ///< particles that left the domain
  /// Gives the liquid particles a velocity and lets the flow see it; for the start of a case.
  void set_state(const std::vector<Vector>& velocity, const std::vector<double>& density);

  /// All particles of all ranks in the engine's order, on the root; nothing elsewhere (collective).
  std::vector<Traveller> gather() const { return gather({}, false); }
  /// The chosen particles of all ranks and those that touch them, in the engine's order, on the
  /// root; nothing elsewhere (collective). @param chosen per entry of particles(); @param touch the
  /// distance below which particles touch, m, at most the kernel's support.
  Particles collect(const std::vector<std::uint8_t>& chosen, double touch) const;

  double total_enthalpy() const;       ///< sum of m H of all ranks, J; collective
  double total_additive_mass() const;  ///< sum of m C of all ranks, kg; collective

 private:
  void prepare();
  void look_from_above();
  double total_of(const std::vector<double>& specific) const;
  void refresh(std::size_t i);
  void refresh_ghosts();
  void check_numbers() const;
  void fill_species_records(const std::vector<double>& concentration);
  void advance_species(double dt);
  void apply(double dt);
  void place_records();
  void place_moving_records();
  void place_record(std::size_t at, std::size_t source, const Vector& position);
  void place_images();
  double lose_surface_heat();
  struct Step {
    double size = 0, end = 0;  // s
    double round = 0;          // s, longest one of heat steps
    int flow_steps = 1;
    int heat_substeps = 0;  // zero: nobody takes any
    StepLimits limits;
  };
  void exchange_heat(const Step& step);
  bool may_open_rounds() const;
  double thermal_limit(double diffusivity) const;
  double stable_specific_heat(double temperature, double concentration) const;
  double best_of_base() const;
  void open_round(const Step& step);
  void find_boundary();
  void exchange_in_substeps(double dt, int parts);
  Step choose_step(double until, double surface_rate) const;
  /// What crosses its liquidus within a step.
  struct Crossing {
    std::uint32_t particle;
    double old_enthalpy, old_temperature;  ///< J kg-1, K
    double begin, size;                    ///< s, of the step
  };
  void note_phase_times(const Crossing& crossing);

  // Flow, in engine_flow.cpp
  void start_flow();
  bool change_phases();
  void copy_phases();
  void refresh_melt();
  void rebuild_lists(bool everything);
  void find_movers();
  Vector listed_at(std::uint32_t i) const;
  void sort_particles();
  void keep_in_period();
  void advance_flow(double dt, int steps);
  void advance_gas(double dt);
  double largest_speed() const;
  double farthest_moved() const;
  [[noreturn]] void report_unstable(std::uint32_t particle, double moved) const;

  // Ranks, in engine_ranks.cpp
  struct Moved {
    std::vector<std::uint32_t> arrived, entries;
  };
  EngineState state(bool everywhere) const;
  /// @param chosen per entry; none: all.
  std::vector<Traveller> gather(const std::vector<std::uint8_t>& chosen, bool everywhere) const;
  double copy_reach() const;
  void check_ranks() const;
  std::vector<std::uint32_t> divide(const std::vector<Vector>& at);
  void take_part(EngineState& state);
  void divide_anew(bool sort);
  bool out_of_balance();
  std::array<std::uint64_t, 3> workload() const;
  std::array<double, 3> unit_costs();
  Moved move_between_ranks(const std::vector<std::uint8_t>& before);
  void update_copies();
  void note_peers(const std::vector<Vector>& at);
  void set_peers(std::vector<Halo::Peer> all);
  Traveller pack(std::uint32_t i) const;
  void unpack(std::uint32_t i, const Traveller& traveller, Home home);
  void add_free_slots();
  std::uint32_t free_slot();
  void fit_fields();

  Particles particles_;
  Mixture mixture_;
  Diffusivity diffusivity_law_;
  Model model_;
  QuinticSpline kernel_, species_kernel_;
  std::unique_ptr<Halo> halo_;  // where it stays when an engine is moved: the flow refers to it
  Decomposition decomposition_;
  std::vector<Ghost> ghosts_;
  MovingNeighbours neighbours_;
  SurfaceColumns surface_;
  SurfaceSearch surface_search_;
  SurfaceConduction surface_conduction_;
  std::vector<HeatRecord> heat_records_;
  SpeciesRecords species_records_;
  std::vector<double> thermal_diffusivity_, diffusivity_, conducted_, source_;
  std::vector<std::uint32_t> liquid_;
  // Of a round of steps, see exchange_heat(). Who conducts in this step; slow ones beside those;
  // who conducts in substeps; others beside those.
  std::vector<std::uint32_t> heat_active_, boundary_, substeppers_, beside_substeppers_;
  std::vector<std::uint8_t> pace_;
  double best_of_base_ = 0;         // m2 s-1: what conducts better may take substeps
  bool heat_holds_ = false;         // the steps back, at this spacing
  std::vector<double> slow_power_;  // W m-3, that slow ones exchange among themselves
  double round_time_ = 0;           // s, so far
  std::uint64_t heat_evaluations_ = 0;
  bool round_open_ = false, round_closes_ = false, boundary_stale_ = true, sort_due_ = false;
  double start_temperature_ = 0;  // K, of a domain that begins at one temperature
  StepLimits limits_;
  LaserBudget beam_;
  SurfaceLossBudget loss_;
  EnergyLedger ledger_;
  double time_ = 0;
  std::size_t steps_ = 0;

  std::optional<FreeSurfaceFlow> flow_;
  std::optional<GasFlow> gas_;
  std::vector<std::uint8_t> mobile_;   // when the lists were made: moves, or may begin to
  std::vector<std::uint32_t> movers_;  // those
  std::vector<Vector> built_at_;       // where movers_ were then
  std::size_t flow_count_ = 0, list_builds_ = 0, builds_since_sort_ = 0, lost_ = 0;
  StepTimes times_, times_at_balance_;
  std::vector<std::uint32_t> free_;  // entries without a particle
  std::size_t settled_ = 0;          // entries before this one are in the order of sums
  std::unordered_map<std::int64_t, std::uint32_t> vacated_;  // of those, whose particle left, by it
  bool slots_added_ = false;                                 // since the last rebuild
  // Of the division among ranks; by clocks, so nothing that is computed depends on it.
  double imbalance_ = 1, imbalance_after_division_ = 1, waited_at_balance_ = 0;
  std::array<double, 3> costs_{};  // s, see unit_costs()
  std::size_t rebuilds_since_division_ = 0;
};

}  // namespace meltproof::solver

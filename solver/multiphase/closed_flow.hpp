// SPDX-License-Identifier: GPL-3.0-or-later
// The closed multi-phase flow: every place in the domain is filled by one of several fluids or by
// wall, so that density is a plain sum over the particles.
#pragma once

#include <cstdint>
#include <vector>

#include "solver/multiphase/depth.hpp"
#include "solver/multiphase/interface.hpp"
#include "solver/multiphase/momentum.hpp"
#include "solver/particles/ghosts.hpp"
#include "solver/particles/neighbours.hpp"
#include "solver/step/time_step.hpp"

namespace meltproof::solver {

/// One fluid at rest.
struct Fluid {
  double density = 1000;     ///< rho_0, kg m-3
  double viscosity = 0;      ///< eta, Pa s
  double conductivity = 0;   ///< W m-1 K-1
  double specific_heat = 1;  ///< J kg-1 K-1
};

/// What conduction needs of a particle beside its FlowRecord.
struct ConductionRecord {
  double temperature = 0, conductivity = 1;  ///< K, W m-1 K-1
};

/// The background pressure p_b of the transport velocity, over p0, between two errors. What shear
/// stores in the arrangement of the particles is lost when v~ - v relaxes it, which brakes a flow
/// like a viscosity; and particles at rest are stirred in proportion to p_b, which also breaks up a
/// square lattice within some 3000 p0/p_b steps per factor e. README.md has the measurements. The
/// stiffest disorder relaxes by p_b/(10 p0) in an acoustic step.
inline constexpr double background_at_rest = 1, background_in_shear = 8;
/// ClosedFlowModel::density_relaxation of a flow that shears for long, README.md says why.
inline constexpr double relaxation_in_shear = 30;

/// What a flow is made of besides its particles.
struct ClosedFlowModel {
  Domain domain;     ///< faces: periodic, mirror (slip), open (walls of particles stand there)
  Vector gravity{};  ///< m s-2
  std::vector<Fluid> fluids;  ///< a particle's `fluid` counts into this
  double stiffness = 0;       ///< p0 = rho_0 c^2, Pa, of every fluid
  double background = 0;      ///< p_b of the transport velocity, Pa; see background_in_shear
  double added_pressure = 0;  ///< p at rho = rho_0, Pa
  /// N: the density follows continuity and goes to the sum over the particles within N h/c; zero:
  /// it is that sum, as the sources of this form have it. See relaxation_in_shear.
  double density_relaxation = 0;
  double density_diffusion = 0.1;  ///< delta of density_diffusion_pair(), where N is not zero
  double smoothing_length = 0;     ///< m; zero: the spacing
  double skin = 0.4;               ///< of the lists, in smoothing lengths
  bool interface = false;          ///< surface tension between Phase::liquid and Phase::gas
  bool heat = false;               ///< conduction; temperature also acts on nothing else here
};

/// Values a caller may set between steps, one entry per particle in the order of particles().
struct FlowFields {
  std::vector<std::int32_t> fluid;  ///< which fluid; of a wall: -1
  std::vector<double> viscosity;    ///< Pa s; starts as the fluid's
  std::vector<double> tension;      ///< sigma, N m-1, on both sides; its gradient is Marangoni's
  std::vector<double> recoil;       ///< Pa, pushes into the particle's own side
  std::vector<Vector> wall_acceleration;  ///< m s-2, of walls that are accelerated
};

/// **Closed multi-phase flow** (Adami, Hu & Adams 2010, 2012, 2013): V_i = 1/sum_j W_ij (walls in
/// the sum), p by state_pressure(), momentum_pair() with the transport velocity v~ = v - (dt/2)
/// (p_b/m_i) sum (V_i^2 + V_j^2) grad W, walls by wall_pair(), surface tension by colour gradient
/// and curvature; kick, drift, kick. A particle's sums run over its own list, so results do not
/// depend on the number of threads.
class ClosedFlow {
 public:
  /// @param particles Phase::solid is wall and moves with its `velocity`, without being displaced
  /// (a lid slides along itself). `mass` must be rho_0 times the undisturbed `volume`; walls take
  /// any. @param fluid one entry per particle. @throws InputError for a fluid that is not there or
  /// a stiffness that is not positive.
  ClosedFlow(Particles particles, std::vector<std::int32_t> fluid, ClosedFlowModel model);

  /// One step of dt seconds. @throws std::runtime_error if a velocity is no number any more: it
  /// names the particle and the time.
  void advance(double dt);
  /// The largest dt that every criterion allows now, s.
  double stable_step() const { return limits().smallest(); }
  StepLimits limits() const;
  /// Takes all speed away; used while a start settles.
  void stop();

  const Particles& particles() const { return particles_; }
  Particles& particles() { return particles_; }
  const FlowFields& fields() const { return fields_; }
  FlowFields& fields() { return fields_; }
  const ClosedFlowModel& model() const { return model_; }
  ClosedFlowModel& model() { return model_; }
  const std::vector<double>& pressure() const { return pressure_; }          ///< Pa; walls too
  const std::vector<Vector>& acceleration() const { return acceleration_; }  ///< m s-2
  const std::vector<Vector>& normal() const { return normal_; }  ///< unit, or zero away from it
  const std::vector<double>& curvature() const { return curvature_; }  ///< 1/m
  const NeighbourList& neighbours() const { return neighbours_; }
  const QuinticSpline& kernel() const { return kernel_; }
  double time() const { return time_; }
  std::size_t steps() const { return steps_; }
  std::size_t builds() const { return builds_; }  ///< of the neighbour lists
  /// Forces, pressures and curvature from the state as it is; called by the constructor and by
  /// advance(), and by who changes particles() by hand.
  void evaluate() { evaluate_after(0); }

 private:
  /// Where a step of dt seconds ended; zero: no step, densities are sums.
  void evaluate_after(double dt);
  void build_lists();
  void move(double dt);
  void kick(double dt);
  bool is_fluid(std::size_t i) const {
    return particles_.phase[i] == Phase::liquid || particles_.phase[i] == Phase::gas;
  }
  template <class Record, class Change>
  void fill_images(std::vector<Record>& records, const Change& change) const;
  template <int D>
  void evaluate_in(double dt);
  template <int D>
  void sum_density();
  template <int D>
  void continue_density(double dt);
  void fill_records();
  template <int D>
  void extrapolate_to_walls();
  template <int D>
  void sum_forces();
  template <int D>
  void sum_interface();
  template <int D>
  void conduct_heat();

  Particles particles_;
  FlowFields fields_;
  ClosedFlowModel model_;
  QuinticSpline kernel_;
  InterfaceDepth depth_;
  std::vector<Ghost> ghosts_;
  NeighbourList neighbours_;
  std::vector<Vector> built_at_;
  std::vector<FlowRecord> records_;
  std::vector<InterfaceRecord> surface_;
  std::vector<ConductionRecord> heat_;
  std::vector<Vector> acceleration_, background_, surface_force_, normal_, transport_;
  std::vector<double> pressure_, curvature_, heating_, interface_depth_;
  double time_ = 0;
  std::size_t steps_ = 0, builds_ = 0;
};

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// Weakly compressible flow of the melt with a free surface: what is not metal has no particles.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "solver/parallel/halo.hpp"
#include "solver/particles/ghosts.hpp"
#include "solver/particles/kernel.hpp"
#include "solver/particles/loops.hpp"
#include "solver/particles/packed_lists.hpp"
#include "solver/terms/continuity.hpp"
#include "solver/terms/interface.hpp"
#include "solver/terms/pressure.hpp"
#include "solver/terms/viscosity.hpp"

namespace meltproof::solver {

/// What keeps particles of a free surface from clumping under tension.
enum class ClumpingCure {
  none,
  repulsion,  ///< a pair pressure below the lattice's distance, see repulsion_pair()
  transport,  ///< particles move with a transport velocity that evens out their places (Zhang, Hu &
              ///< Adams 2017), without the momentum that this carries
};

/// What the density diffusion acts on, see density_diffusion_pair().
enum class DensityDiffusion {
  plain,      ///< all differences (Molteni & Colagrossi 2009): a smooth profile diffuses too, so a
              ///< layer under gravity slowly sinks in: its pressure is off by 15 % after 10^4 steps
  corrected,  ///< what differs from the local gradient (Antuono et al. 2010): 0.4 % there
};

/// How the melt flows.
struct FlowSettings {
  double sound_speed = 50;  ///< c, m s-1: p = c^2 (rho - rho0)
  /// C of the acoustic limit C h/(c + |v|). Morris et al. (1997) and the paper's Eq. 5 have 0.25.
  double courant = 0.4;
  double density_diffusion = 0.1;  ///< delta of Molteni & Colagrossi
  DensityDiffusion diffusion_form = DensityDiffusion::corrected;
  /// N of density_excess(): densities go to the particles' own sum within N smoothing lengths'
  /// travel of sound; zero: never.
  double density_relaxation = 10;
  double viscosity_factor = 20;     ///< on the material's real viscosity (paper, note of Table A2)
  double artificial_viscosity = 0;  ///< alpha of Monaghan
  Vector gravity{0, 0, -9.81};      ///< m s-2
  bool surface_tension = true, marangoni = true, recoil = true;
  ClumpingCure cure = ClumpingCure::repulsion;
  double repulsion = 3e5;           ///< Pa, k of repulsion_pair()
  double repulsion_distance = 0.8;  ///< d of repulsion_pair(), in spacings
  double transport_pressure = 1e6;  ///< Pa, least p0 of the transport velocity, 10 |p| at most
  /// beta: below the surface particles move with a transport velocity of background pressure beta
  /// rho c h |grad v|, without the momentum that this carries. It relaxes what shear loads into
  /// their arrangement, which otherwise carries stress; without shear there is nothing to relax. At
  /// most 0.2 rho c^2: in splashes |grad v| has no bound.
  double shifting = 10;
  double skin = 0.5;  ///< of the Verlet lists, in spacings
  /// All solid counts as wall, melt near it or not, so that every particle has the passes of its
  /// kind. For measuring what is gained; on one rank.
  bool walls_everywhere = false;
};

/// What the melt is like at one particle.
struct MeltProperties {
  double viscosity = 0;        ///< Pa s, factor included
  double surface_tension = 0;  ///< N m-1; of solids too, for its gradient
  double recoil = 0;           ///< Pa
};

/// What the flow takes from one step into the next, an entry per liquid particle in the order of
/// the particles.
struct FlowMemory {
  std::vector<Vector> acceleration;  ///< m s-2
  std::vector<Vector> shift;         ///< m s-2, times the step the transport velocity's share
  std::vector<double> area;          ///< m^(d-1)
  std::vector<double> pressure;      ///< Pa
  std::vector<double> viscosity, surface_tension, recoil;  ///< MeltProperties
};

/// What the flow keeps of a particle near the melt when lists or phases change, and what it takes
/// along when another rank comes to own or to copy it.
struct FlowParticle {
  Vector colour{}, density_gradient{}, tension_gradient{}, acceleration{}, shift{};
  double exposed = 0, pressure = 0;
  MeltProperties properties;
};

/// Counts of everything that limited a value, since the start of a run.
struct LimiterCounts {
  std::uint64_t wall_pressure = 0;  ///< wall pressures clipped at zero, particle steps
  std::uint64_t curvature = 0;  ///< curvatures held at what the spacing can hold, particle steps
  std::uint64_t particle_steps = 0;  ///< of liquid particles, to compare with
  std::uint64_t wall_steps = 0;      ///< of wall particles, likewise
};

/// **One step of the flow**, velocity Verlet: half a kick and the drift; then the density at
/// (x^{n+1}, v^{n+1/2}), because taken from the step before it a drop breathes forty times its own
/// pressure; then walls, interface and forces; then the other half kick. Sums are gathered over
/// lists whose order belongs to the particle. Each rank computes its own particles; what their
/// neighbours' sums need of them goes to the copies between two passes.
///
/// Melt and walls are a small part of the metal, so everything the flow knows stands in **slots**
/// of its own, in the particles' order without the gaps: arrange() hands them out, and its own
/// lists name slots. Whoever asks from outside asks by particle, and is told zero of one without.
class FreeSurfaceFlow {
 public:
  /// @param halo brings values to copies on other ranks; outlives the flow.
  FreeSurfaceFlow(const FlowSettings& settings, const QuinticSpline& kernel, double spacing,
                  int dimensions, Halo& halo);

  /// To be called when phases or lists have changed: finds liquid and wall particles. What is known
  /// of those that were there before stays.
  void arrange(const Particles& particles, const std::vector<Ghost>& ghosts,
               const PackedLists& list);
  /// To be called when indices change: nothing is known any more of anybody, until set_particle()
  /// or set_properties() and evaluate().
  void forget();
  /// What melt, walls and their copies are like now. @param of takes a particle's index and returns
  /// its MeltProperties; called on several threads.
  template <class Of>
  void set_melt(const Of& of) {
    for_each_particle(particle_.size(), [&](std::size_t s) { melt_[s] = of(particle_[s]); });
  }
  /// To be called when the properties have changed: gradients of the surface tension.
  void set_properties(const Particles& particles, const std::vector<Ghost>& ghosts);

  /// First half kick and drift of the liquid particles.
  void kick_and_drift(Particles& particles, double dt);
  /// Density, forces and second half kick, at the new positions.
  void finish(Particles& particles, const std::vector<Ghost>& ghosts, double dt);

  /// Forces at the present positions, without advancing anything; needed once at the start and
  /// whenever indices have changed.
  void evaluate(const Particles& particles, const std::vector<Ghost>& ghosts);

  /// Brings places and velocities of the liquid to its copies.
  void follow(Particles& particles);

  /// For a particle that goes to another rank.
  FlowParticle particle(std::uint32_t i) const;
  /// For one that comes from there: holds from the next arrange() on.
  void set_particle(std::uint32_t i, const FlowParticle& what) { arrived_.emplace_back(i, what); }

  /// For a run that is stopped and continued; of the particles of this rank.
  FlowMemory memory() const;
  /// Takes it back, once arrange() has found the same liquid particles.
  void remember(const FlowMemory& memory, const LimiterCounts& limiters);

  /// Area through which liquid particle i gives off heat, m^(d-1), see exposed_area(); zero inside.
  double area(std::uint32_t i) const { return of(exposed_, i); }
  double pressure(std::uint32_t i) const { return of(pressure_, i); }  ///< Pa
  MeltProperties properties(std::uint32_t i) const { return of(melt_, i); }
  const std::vector<std::uint32_t>& liquid() const { return liquid_; }
  const std::vector<std::uint32_t>& wall() const { return wall_; }
  const LimiterCounts& limiters() const { return limiters_; }
  const FlowSettings& settings() const { return settings_; }

  /// Which term made the acceleration of liquid particle i no number: a sentence.
  std::string diagnose(const Particles& particles, std::uint32_t i) const;

 private:
  /// Positions and motion; one cache line.
  struct alignas(64) MotionRecord {
    double x = void_position, y = void_position, z = void_position, vx = 0, vy = 0, vz = 0;
    double volume = 0;   // m^d
    double density = 0;  // kg m-3, zero in the solid
  };
  /// Gradient of the density, corrected; half a cache line. Zero in the solid.
  struct alignas(32) DensityRecord {
    double x = 0, y = 0, z = 0;  // kg m-4
  };
  /// The interface; one cache line.
  struct alignas(64) SurfaceRecord {
    double x = void_position, y = void_position, z = void_position, nx = 0, ny = 0, nz = 0;
    double tension = 0;  // N m-1
    double depth = 0;    // m, below the surface; zero where there is no interface
  };
  /// What lower layers take their curvature from; zero but in the outermost layer of the melt.
  struct alignas(16) CurvatureRecord {
    double curvature = 0, weight = 0;  // times the weight, m^(d-2); m^(d-1)
  };
  /// Forces; two cache lines.
  struct alignas(64) ForceRecord {
    double x = void_position, y = void_position, z = void_position, vx = 0, vy = 0, vz = 0;
    double volume = 0, pressure = 0;
    double density = 0;    // kg m-3, zero in the solid
    double viscosity = 0;  // Pa s
  };

  static constexpr std::uint32_t nowhere = 0xffffffff;
  /// Of a particle without a slot, nothing.
  template <class Value>
  Value of(const std::vector<Value>& values, std::uint32_t i) const {
    const std::uint32_t s = i < slot_.size() ? slot_[i] : nowhere;
    return s == nowhere ? Value{} : values[s];
  }

  void find_roles(const Particles& particles, const std::vector<Ghost>& ghosts,
                  const PackedLists& list);
  void hand_out_slots(const Particles& particles, const std::vector<Ghost>& ghosts,
                      const PackedLists& list);
  void translate_lists(const PackedLists& list);
  void fit();
  void place_standing(const Particles& particles, const std::vector<Ghost>& ghosts);
  void make_room_for_near();
  void find_near();
  void write_motion(const Particles& particles, const std::vector<Ghost>& ghosts);
  void colour_gradients();
  void density_gradients(const std::vector<Ghost>& ghosts);
  void densities(Particles& particles, double dt);
  void write_surface(const Particles& particles, const std::vector<Ghost>& ghosts);
  void leave_disorder_out();
  void curvatures(const std::vector<Ghost>& ghosts);
  void curvatures_below();
  void missing_gradients();
  void walls_and_missing_gradients(const std::vector<Ghost>& ghosts);
  void forces(const Particles& particles);
  /// Calls visit(slot, ghost, slot of its source) for each image of melt and walls.
  template <class Visit>
  void for_each_image(const std::vector<Ghost>& ghosts, const Visit& visit) const {
    for (std::uint32_t g = 0; g < near_ghosts_.size(); ++g) {
      const Ghost& ghost = ghosts[near_ghosts_[g]];
      visit(static_cast<std::uint32_t>(particle_.size()) + g, ghost, slot_[ghost.source]);
    }
  }

  /// Members of liquid_ or wall_, by their place there: those of which other ranks keep copies, and
  /// the others. Alone both stay empty.
  struct Parts {
    std::vector<std::uint32_t> copied, inner;
  };
  enum class Part { copied, inner };
  /// Runs body(place) for one part of n members; alone, all of them are inner ones.
  template <class Body>
  void for_each_of(const Parts& parts, Part part, std::size_t n, const Body& body) {
    if (halo_.empty()) {
      for_each_sum(part == Part::inner ? n : 0, body);
      return;
    }
    const auto& members = part == Part::inner ? parts.inner : parts.copied;
    // A message moves on only when this rank looks after it.
    const std::size_t chunk = members.size() / 4 + 1;
    for (std::size_t from = 0; from < members.size(); from += chunk) {
      for_each_sum(std::min(chunk, members.size() - from),
                   [&](std::size_t k) { body(members[from + k]); });
      if (part == Part::inner) {
        halo_.progress();
      }
    }
  }
  /// Computes what others keep copies of first, so that it is on the way while the rest is
  /// computed: compute(part) for both.
  template <class Compute, class Get, class Put>
  void compute_and_exchange(Halo::Group group, std::size_t width, const Compute& compute,
                            const Get& get, const Put& put) {
    compute(Part::copied);
    halo_.begin(group, width, get);
    compute(Part::inner);
    halo_.finish(put);
  }

  FlowSettings settings_;
  QuinticSpline kernel_;
  double spacing_;
  int dimensions_;
  Halo& halo_;
  // Particles of this rank, and their slots in the same order.
  std::vector<std::uint32_t> liquid_, wall_, liquid_slot_, wall_slot_;
  Parts liquid_parts_, wall_parts_;
  std::vector<std::uint32_t> liquid_copies_, wall_copies_;  // particles of others
  std::vector<std::uint8_t> role_;          // of every particle: 0 neither, 1 liquid, 2 wall
  std::vector<std::uint32_t> slot_;         // of every particle, or nowhere
  std::vector<std::uint32_t> particle_;     // of every slot of melt and walls, increasing
  std::vector<std::uint32_t> near_ghosts_;  // images of those, whose slots follow
  // Behind them the void, and behind it the metal that only walls have in reach: it stands still,
  // and only its place and volume are known.
  std::vector<std::uint32_t> behind_walls_;
  NeighbourList list_;            // of slots: of the melt and the walls of this rank
  NeighbourList melt_near_wall_;  // of wall_slot_[k], k in place of the slot: liquid only
  // Of liquid_slot_[k], k in place of the slot: what of its list is within the kernel's support.
  NeighbourList near_;
  std::vector<std::pair<std::uint32_t, FlowParticle>> arrived_;  // since the last arrange()
  std::vector<MotionRecord> motion_;
  std::vector<DensityRecord> density_gradient_;
  std::vector<SurfaceRecord> surface_;
  std::vector<CurvatureRecord> outer_curvature_;
  std::vector<ForceRecord> force_;
  std::vector<MeltProperties> melt_;
  std::vector<Vector> colour_, normal_, tension_gradient_, acceleration_, shift_;
  SurfaceDepth depth_;
  double lattice_sum_ = 1;      // sum V W of the undisturbed lattice
  double outermost_depth_;      // over h
  double alone_ = 0;            // the share of it that a particle itself has
  std::vector<double> filled_;  // share of the kernel that neighbours fill
  std::vector<double> area_, exposed_, curvature_, pressure_;
  std::vector<Vector> missing_gradient_;  // Pa m-1, of the pressure along the surface
  std::vector<double> pull_;  // m^(d-1), 2 |grad c| V: what a pressure on the surface acts on
  std::vector<std::uint8_t> limited_, disorder_;
  LimiterCounts limiters_;
};

}  // namespace meltproof::solver

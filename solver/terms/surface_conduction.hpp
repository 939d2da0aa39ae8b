// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/particles/ghosts.hpp"
#include "solver/terms/conduction.hpp"

namespace meltproof::solver {

/// The share that is added to the exchange of a pair near a free surface: the mean over both of
/// gain (1 - (e . n)^2), e along the pair, n the surface's normal at each, gain zero inside.
/// Symmetric, so that what one loses the other receives.
/// @param dx, dy, dz in m; @param inverse_square 1/(dx^2 + dy^2 + dz^2).
template <class T>
T surface_share(const T& dx, const T& dy, const T& dz, const T& inverse_square, const T& gain_i,
                const T& nx_i, const T& ny_i, const T& nz_i, const T& gain_j, const T& nx_j,
                const T& ny_j, const T& nz_j) {
  const T along_i = dx * nx_i + dy * ny_i + dz * nz_i, along_j = dx * nx_j + dy * ny_j + dz * nz_j;
  return 0.5 * (gain_i * (1.0 - along_i * along_i * inverse_square) +
                gain_j * (1.0 - along_j * along_j * inverse_square));
}

/// What is known of the free surface at a particle: nothing inside the metal.
struct alignas(32) SurfaceRecord {
  double gain = 0;                ///< 1
  double nx = 0, ny = 0, nz = 0;  ///< outward
};

/// **Conduction along a free surface.** A particle at the surface lacks the neighbours outside, so
/// the sum of conduction_pair() lets heat flow along the surface through half a support only: its
/// second moment there, -sum V F r_t^2/2, is not 1. This restores it: surface_share() is chosen
/// such that the moment along the surface is 1 for every particle of it, by some sweeps over the
/// unknown gains, which stay between bounds that keep every exchange downhill. Across the surface
/// nothing changes, and no energy is lost.
class SurfaceConduction {
 public:
  static constexpr double smallest_gain = -0.3, largest_gain = 2;

  /// Finds the surface and its gains. To be called whenever the lists are remade.
  /// @param records as in conduct(); @param kernel whose second lattice moment is exact;
  /// @param among the particles whose surroundings may have changed since the last call with the
  /// same indices; null: all.
  void update(const std::vector<HeatRecord>& records, const std::vector<Ghost>& ghosts,
              const PackedLists& neighbours, const QuinticSpline& kernel,
              const std::vector<std::uint32_t>* among = nullptr);

  /// Adds what the surface conducts beyond conduct(), W m-3, to the particles in `active`, in pairs
  /// of which one is awake.
  void add(const std::vector<HeatRecord>& records, const PackedLists& neighbours,
           const QuinticSpline& kernel, const std::vector<std::uint32_t>& active,
           std::vector<double>& power) const;

  /// Per particle, then ghosts and the void.
  const std::vector<SurfaceRecord>& surface() const { return surface_; }

 private:
  std::vector<SurfaceRecord> surface_;
  std::vector<std::uint8_t> outer_;       // on the surface
  std::vector<std::uint8_t> takes_part_;  // that, or with a neighbour that has a gain
};

}  // namespace meltproof::solver

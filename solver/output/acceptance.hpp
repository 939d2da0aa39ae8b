// SPDX-License-Identifier: GPL-3.0-or-later
// What must be looked at before a flow run is believed: particles that clump, leave, or sink in
// leave length, width, temperature and energy looking right.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "solver/output/metal_grid.hpp"
#include "solver/output/occupancy.hpp"

namespace meltproof::solver {

/// Where to look, and what is asked.
struct AcceptanceSettings {
  Vector lower = MetalGrid::everywhere(-1);  ///< of the domain, m; beyond it a particle is lost
  Vector upper = MetalGrid::everywhere(1);   ///< m
  double from = 0,
         to = 0;      ///< m, x limits of the solidified track, its start left out; equal: none
  double centre = 0;  ///< m, y of the track
  double width = 0;   ///< m, across the track, over which the surface is averaged

  double clumped_asked = 0.01;  ///< of the melt particles, below half a spacing to a neighbour
  double volume_asked = 0.05;   ///< relative; weak compressibility takes 1 to 3 %, the method 1 %
  double height_asked = -1;     ///< spacings, mean height of the refilled track at least
};

/// Distances of some particles to their nearest neighbour of any metal, in spacings, cut at 3.
struct NearestDistances {
  std::size_t particles = 0;
  double clumped = 0;   ///< share below 0.5
  double smallest = 0;  ///< 0 if there are no particles
  double median = 0;
};

/// The distances of the chosen particles (`chosen[i]` not 0).
NearestDistances measure_nearest(const MetalGrid& grid, const Particles& particles,
                                 const std::vector<std::uint8_t>& chosen);

/// Share of the liquid particles that sit closer than half a spacing to another one; 0 if none is
/// liquid.
double clumped_fraction(const Particles& particles);

/// Particles whose phase is lost, or that are not inside the box, or at no place at all (NaN).
std::size_t count_lost(const Particles& particles, const Vector& lower, const Vector& upper);

/// Everything measured of one state.
struct Acceptance {
  AcceptanceSettings asked;
  double spacing = 0;  ///< m
  NearestDistances liquid, ever_melted;
  /// Mean of the melt's clumped share over a window of time. Where it is given it is judged in
  /// place of the share at one instant, in which a single pair of a small pool would decide.
  std::optional<double> clumped_mean;
  std::size_t lost = 0;
  FilledVolume liquid_volume, ever_melted_volume;
  bool has_height = false;
  SurfaceHeight height;  ///< if has_height

  /// Whether nothing clumps, is lost, sinks in or stays a trench, as asked.
  bool pass() const;
  /// Lengths in um, volumes in um3, shares as they are; units in the keys.
  nlohmann::json json() const;
  /// A few lines with what was found, what is asked and whether it is held, for the end of a run.
  std::string table() const;
};

/// Measures a state, whatever the order of its particles in memory.
Acceptance measure_acceptance(const Particles& particles, const AcceptanceSettings& settings);

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// What the camera sees of particles: the first metal on each ray, from a section plane on.
#pragma once

#include <array>
#include <vector>

#include "imaging/camera/scene.hpp"

namespace meltproof::imaging {

/// Particles at one instant, as a run's snapshot holds them.
struct ParticleSnapshot {
  double time = 0;                      ///< s
  std::array<double, 3> beam{};         ///< m
  std::vector<double> position;         ///< 3 n, m: x, y, z of every particle
  std::vector<double> temperature;      ///< n, K
  std::vector<double> liquid_fraction;  ///< n, 1
  double spacing = 0;                   ///< m: a particle stands for a cell of spacing cubed
};

/// The scene of a camera that looks along y (settings: section, look) on particles, on a lattice or
/// not.
///
/// Every ray starts at the plane y = section and meets slabs one spacing thick behind it. Within a
/// slab temperature and emissivity are Shepard means, sum W f / sum W, with the Wendland C2 kernel
/// of radius two spacings in the plane of the image; the ray has met metal where spacing^2 sum W
/// reaches one half, which puts the outline of a body half a spacing outside its outermost
/// particles, where their cells end. The ray ends in the first slab with metal; what lies before
/// the plane is cut away; a ray that leaves the particles sees the surroundings. Self-emission of
/// one surface only: no reflections between surfaces.
Scene render_section(const ParticleSnapshot& snapshot, const CameraSettings& camera,
                     const SceneGrid& grid);

/// The sentence that recordings carry about what is seen.
std::string section_statement(const CameraSettings& camera);

}  // namespace meltproof::imaging

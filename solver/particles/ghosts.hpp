// SPDX-License-Identifier: GPL-3.0-or-later
// The faces of the domain, made of images of its particles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "solver/particles/particles.hpp"

namespace meltproof::solver {

/// What lies beyond a face of the domain.
enum class Face {
  open,         ///< nothing: no flux of anything
  periodic,     ///< the opposite side of the domain
  mirror,       ///< a plane of symmetry: no flux, full kernel support
  temperature,  ///< a wall held at a temperature: the image mirrors it about the wall's
};

/// The box and its faces; a face is {axis, 0 lower | 1 upper}.
struct Domain {
  Vector lower{}, upper{};                             ///< m
  std::array<std::array<Face, 2>, 3> face{};           ///< default: open
  std::array<std::array<double, 2>, 3> temperature{};  ///< K, for Face::temperature
};

/// One image: its source, its place, and T_image = sign * T_source + offset.
struct Ghost {
  std::uint32_t source;
  Vector position;
  double sign, offset;
};

/// All images within `reach` of the domain, axis after axis, so that edges and corners are filled
/// too. A periodic box may be thinner than the reach: as many images as needed are made.
std::vector<Ghost> make_ghosts(const Particles& particles, const Domain& domain, double reach);

}  // namespace meltproof::solver

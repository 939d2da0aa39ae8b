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
  /// position = scale * position of the source + shift, axis by axis; scale is 1 or, mirrored, -1.
  Vector scale{1, 1, 1}, shift{};

  /// Where the image stands once its source has moved to `at`.
  Vector image_of(const Vector& at) const {
    return {scale[0] * at[0] + shift[0], scale[1] * at[1] + shift[1], scale[2] * at[2] + shift[2]};
  }
  /// The image of a velocity or another vector of the source.
  Vector mirrored(const Vector& v) const {
    return {scale[0] * v[0], scale[1] * v[1], scale[2] * v[2]};
  }
};

/// All images within `reach` of the domain, axis after axis, so that edges and corners are filled
/// too. A periodic box may be thinner than the reach: as many images as needed are made.
std::vector<Ghost> make_ghosts(const Particles& particles, const Domain& domain, double reach);

}  // namespace meltproof::solver

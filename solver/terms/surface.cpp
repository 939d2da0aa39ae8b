// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/terms/surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meltproof::solver {
namespace {

/// Leaves a particle on top of a column only on the rank whose it is and where it is the highest of
/// all ranks', of equally high ones the one with the smallest identity.
void settle(SurfaceColumns& columns, const Particles& particles, const Ranks& ranks) {
  const double nothing = -std::numeric_limits<double>::infinity();
  std::vector<double> height(columns.top.size(), nothing), identity(columns.top.size(), -nothing);
  for (std::size_t c = 0; c < height.size(); ++c) {
    if (columns.top[c] != SurfaceColumns::none) {
      height[c] = particles.position[columns.top[c]][2];
    }
  }
  std::vector<double> highest = height;
  ranks.largest(highest);
  for (std::size_t c = 0; c < height.size(); ++c) {
    if (height[c] == highest[c] && height[c] != nothing) {
      // Identities are far below 2^53.
      identity[c] = static_cast<double>(particles.identity[columns.top[c]]);
    }
  }
  std::vector<double> first = identity;
  ranks.smallest(first);
  for (std::size_t c = 0; c < height.size(); ++c) {
    if (highest[c] != nothing && identity[c] != first[c]) {
      columns.top[c] = SurfaceColumns::elsewhere;
    }
  }
}

}  // namespace

SurfaceColumns find_surface(const Particles& particles, const Vector& lower, const Vector& upper,
                            const Slant& slant, const Ranks& ranks) {
  SurfaceColumns columns;
  columns.lower_x = lower[0];
  columns.lower_y = lower[1];
  columns.width = particles.spacing / 2;
  columns.count_x = static_cast<std::size_t>(std::llround((upper[0] - lower[0]) / columns.width));
  columns.count_y = static_cast<std::size_t>(std::llround((upper[1] - lower[1]) / columns.width));
  columns.top.assign(columns.count_x * columns.count_y, SurfaceColumns::none);
  const auto higher = [&](std::uint32_t a, std::uint32_t b) {
    const double za = particles.position[a][2], zb = particles.position[b][2];
    return za != zb ? za > zb : particles.identity[a] < particles.identity[b];
  };
  // Column axes within [-spacing/2, spacing/2) of the particle: always two by two. Rounding the
  // lower edge keeps that count when a particle sits exactly between columns, as on the starting
  // lattice; the small addition does so where a slant puts a layer half a column off.
  const auto first_column = [&](double x, double edge) {
    return static_cast<std::int64_t>(
        std::llround((x - particles.spacing / 2 - edge) / columns.width + 1e-6));
  };
  for (std::uint32_t i = 0; i < particles.size(); ++i) {
    if (particles.home[i] == Home::nowhere) {
      continue;
    }
    const Vector& at = particles.position[i];
    const std::int64_t x0 = first_column(at[0] + slant.x * at[2], columns.lower_x);
    const std::int64_t y0 = first_column(at[1] + slant.y * at[2], columns.lower_y);
    for (std::int64_t iy = std::max<std::int64_t>(0, y0);
         iy < std::min<std::int64_t>(y0 + 2, static_cast<std::int64_t>(columns.count_y)); ++iy) {
      for (std::int64_t ix = std::max<std::int64_t>(0, x0);
           ix < std::min<std::int64_t>(x0 + 2, static_cast<std::int64_t>(columns.count_x)); ++ix) {
        auto& top =
            columns
                .top[static_cast<std::size_t>(iy) * columns.count_x + static_cast<std::size_t>(ix)];
        if (top == SurfaceColumns::none || higher(i, top)) {
          top = i;
        }
      }
    }
  }
  if (!ranks.alone()) {
    if (slant.x != 0 || slant.y != 0) {
      settle(columns, particles, ranks);
    }
    for (std::uint32_t& top : columns.top) {
      if (top < particles.size() && particles.home[top] != Home::here) {
        top = SurfaceColumns::elsewhere;
      }
    }
  }
  return columns;
}

}  // namespace meltproof::solver

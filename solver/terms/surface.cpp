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

/// What is over the plan view of the domain: nothing yet.
SurfaceColumns empty_columns(double spacing, const Vector& lower, const Vector& upper) {
  SurfaceColumns columns;
  columns.lower_x = lower[0];
  columns.lower_y = lower[1];
  columns.width = spacing / 2;
  columns.count_x = static_cast<std::size_t>(std::llround((upper[0] - lower[0]) / columns.width));
  columns.count_y = static_cast<std::size_t>(std::llround((upper[1] - lower[1]) / columns.width));
  columns.top.assign(columns.count_x * columns.count_y, SurfaceColumns::none);
  return columns;
}

bool there(const Particles& particles, std::uint32_t i) {
  return particles.home[i] != Home::nowhere && particles.phase[i] != Phase::lost;
}

/// First of the two columns along one axis that a particle at `x` fills. Their axes are within
/// [-spacing/2, spacing/2) of the particle: always two by two. Rounding the lower edge keeps that
/// count when a particle sits exactly between columns, as on the starting lattice; the small
/// addition does so where a slant puts a layer half a column off.
std::int64_t first_column(double x, double edge, const SurfaceColumns& columns) {
  return static_cast<std::int64_t>(std::llround((x - columns.width - edge) / columns.width + 1e-6));
}

/// Puts particle i on top of those of its columns where nothing higher is.
void look_at(SurfaceColumns& columns, const Particles& particles, const Slant& slant,
             std::uint32_t i) {
  const auto higher = [&](std::uint32_t a, std::uint32_t b) {
    const double za = particles.position[a][2], zb = particles.position[b][2];
    return za != zb ? za > zb : particles.identity[a] < particles.identity[b];
  };
  const Vector& at = particles.position[i];
  const std::int64_t x0 = first_column(at[0] + slant.x * at[2], columns.lower_x, columns);
  const std::int64_t y0 = first_column(at[1] + slant.y * at[2], columns.lower_y, columns);
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

/// Of several ranks, whose particle is on top is left to its owner.
void leave_to_owners(SurfaceColumns& columns, const Particles& particles, const Slant& slant,
                     const Ranks& ranks) {
  if (ranks.alone()) {
    return;
  }
  if (slant.x != 0 || slant.y != 0) {
    settle(columns, particles, ranks);
  }
  for (std::uint32_t& top : columns.top) {
    if (top < particles.size() && particles.home[top] != Home::here) {
      top = SurfaceColumns::elsewhere;
    }
  }
}

}  // namespace

SurfaceColumns find_surface(const Particles& particles, const Vector& lower, const Vector& upper,
                            const Slant& slant, const Ranks& ranks) {
  SurfaceColumns columns = empty_columns(particles.spacing, lower, upper);
  for (std::uint32_t i = 0; i < particles.size(); ++i) {
    if (there(particles, i)) {
      look_at(columns, particles, slant, i);
    }
  }
  leave_to_owners(columns, particles, slant, ranks);
  return columns;
}

void SurfaceSearch::forget() {
  known_ = false;
  moves_.clear();
  movers_.clear();
}

void SurfaceSearch::moves(const std::vector<std::uint32_t>& particles) {
  for (const std::uint32_t i : particles) {
    if (i >= moves_.size()) {
      moves_.resize(i + std::size_t{1}, 0);
    }
    if (moves_[i] == 0) {
      moves_[i] = 1;
      movers_.push_back(i);
    }
  }
}

SurfaceColumns SurfaceSearch::find(const Particles& particles, const Vector& lower,
                                   const Vector& upper, const Slant& slant, const Ranks& ranks) {
  SurfaceColumns columns;
  bool found = false;
  if (known_) {
    columns = empty_columns(particles.spacing, lower, upper);
    for (const auto* some : {&candidates_, &movers_}) {
      for (const std::uint32_t i : *some) {
        if (there(particles, i)) {
          look_at(columns, particles, slant, i);
        }
      }
    }
    found = true;
    for (std::size_t c = 0; c < columns.top.size() && found; ++c) {
      // Where nobody stood, only who has moved can be.
      found = bare_[c] != 0 || (columns.top[c] != SurfaceColumns::none &&
                                particles.position[columns.top[c]][2] >= floor_[c]);
    }
  }
  if (!found) {
    columns = empty_columns(particles.spacing, lower, upper);
    for (std::uint32_t i = 0; i < particles.size(); ++i) {
      if (there(particles, i)) {
        look_at(columns, particles, slant, i);
      }
    }
    choose(columns, particles, slant);
  }
  leave_to_owners(columns, particles, slant, ranks);
  return columns;
}

/// Candidates are those above a floor that lies some layers below the surface around them, so that
/// the surface may sink for a while before everybody has to be looked at again.
void SurfaceSearch::choose(const SurfaceColumns& columns, const Particles& particles,
                           const Slant& slant) {
  constexpr std::int64_t around = 4;  // columns, so two spacings
  constexpr double layers = 6;
  const auto nx = static_cast<std::int64_t>(columns.count_x),
             ny = static_cast<std::int64_t>(columns.count_y);
  const double never = std::numeric_limits<double>::infinity();
  bare_.assign(columns.top.size(), 0);
  std::vector<double> height(columns.top.size(), never);
  for (std::size_t c = 0; c < columns.top.size(); ++c) {
    if (columns.top[c] == SurfaceColumns::none) {
      bare_[c] = 1;
    } else {
      height[c] = particles.position[columns.top[c]][2] - layers * particles.spacing;
    }
  }
  // The lowest around each, first along x, then along y.
  std::vector<double> along_x(height.size(), never);
  floor_.assign(height.size(), never);
  const auto at = [&](std::int64_t x, std::int64_t y) {
    return static_cast<std::size_t>(y * nx + x);
  };
  for (std::int64_t y = 0; y < ny; ++y) {
    for (std::int64_t x = 0; x < nx; ++x) {
      for (std::int64_t k = std::max<std::int64_t>(0, x - around);
           k <= std::min(nx - 1, x + around); ++k) {
        along_x[at(x, y)] = std::min(along_x[at(x, y)], height[at(k, y)]);
      }
    }
  }
  for (std::int64_t y = 0; y < ny; ++y) {
    for (std::int64_t x = 0; x < nx; ++x) {
      for (std::int64_t k = std::max<std::int64_t>(0, y - around);
           k <= std::min(ny - 1, y + around); ++k) {
        floor_[at(x, y)] = std::min(floor_[at(x, y)], along_x[at(x, k)]);
      }
    }
  }
  candidates_.clear();
  for (std::uint32_t i = 0; i < particles.size(); ++i) {
    if (!there(particles, i)) {
      continue;
    }
    const Vector& place = particles.position[i];
    const std::int64_t x0 = first_column(place[0] + slant.x * place[2], columns.lower_x, columns);
    const std::int64_t y0 = first_column(place[1] + slant.y * place[2], columns.lower_y, columns);
    bool high = false;
    for (std::int64_t y = std::max<std::int64_t>(0, y0); y < std::min(y0 + 2, ny); ++y) {
      for (std::int64_t x = std::max<std::int64_t>(0, x0); x < std::min(x0 + 2, nx); ++x) {
        high = high || place[2] >= floor_[at(x, y)];
      }
    }
    if (high) {
      candidates_.push_back(i);
    }
  }
  known_ = true;
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/occupancy.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "solver/particles/exact_sum.hpp"
#include "solver/particles/loops.hpp"

namespace meltproof::solver {
namespace {

constexpr double support = 2;  // of the colour's kernel, spacings
// c at a particle's own place: 0.42 alone, 0.57 in a row, 0.75 in a film, 0.85 on a flat surface.
constexpr double lone_colour = 0.65;

/// Wendland C2 in three dimensions, m^-3: 21 / (2 pi R^3) (1 - q)^4 (1 + 4 q), q = r / R.
/// (Wendland 1995)
struct Wendland {
  double reach, normalisation;
  explicit Wendland(double spacing)
      : reach(support * spacing),
        normalisation(21 / (2 * std::numbers::pi * reach * reach * reach)) {}
  double operator()(double r2) const {
    const double q = std::sqrt(r2) / reach, p = (1 - q) * (1 - q);
    return q < 1 ? normalisation * p * p * (1 + 4 * q) : 0;
  }
  /// The slope of c across a flat surface, m^-1: integral of W over a plane through its centre,
  /// 2 pi int W r dr = 3 / (2 R).
  double slope() const { return 1.5 / reach; }
};

struct Sample {
  double colour = 0;
  double nearest = std::numeric_limits<double>::infinity();  // m2
  std::uint32_t owner = 0;
};

Sample sample(const MetalGrid& grid, const Particles& p, const Wendland& kernel, const Vector& at) {
  Sample s;
  grid.for_each_within(at, kernel.reach, [&](std::uint32_t j, double r2) {
    s.colour += p.volume[j] * kernel(r2);
    if (r2 < s.nearest) {
      s.nearest = r2;
      s.owner = j;
    }
  });
  return s;
}

}  // namespace

double colour(const MetalGrid& grid, const Particles& particles, const Vector& at) {
  return sample(grid, particles, Wendland(particles.spacing), at).colour;
}

FilledVolume fill(const MetalGrid& grid, const Particles& p,
                  const std::vector<std::uint8_t>& chosen) {
  if (p.dimensions != 3) {
    throw std::invalid_argument("a filled volume needs three dimensions");
  }
  FilledVolume result;
  // Blocks of one spacing that a chosen particle's sphere or kernel can reach.
  std::array<std::size_t, 3> count{};
  Vector lower = grid.lower();
  for (std::size_t d = 0; d < 3; ++d) {
    lower[d] -= support * p.spacing;
    count[d] = static_cast<std::size_t>((grid.upper()[d] - lower[d]) / p.spacing + support) + 2;
  }
  std::vector<std::uint8_t> marked(count[0] * count[1] * count[2], 0);
  for (const std::uint32_t i : grid.by_identity()) {
    if (chosen[i] == 0) {
      continue;
    }
    ++result.particles;
    result.mass_volume += p.volume[i];
    std::array<std::size_t, 3> c{};
    for (std::size_t d = 0; d < 3; ++d) {
      c[d] = static_cast<std::size_t>((p.position[i][d] - lower[d]) / p.spacing);
    }
    // A sub-cell can be filled only where a metal particle is within 1.5 spacings of it.
    for (std::size_t z = c[2] - 2; z <= c[2] + 2; ++z) {
      for (std::size_t y = c[1] - 2; y <= c[1] + 2; ++y) {
        for (std::size_t x = c[0] - 2; x <= c[0] + 2; ++x) {
          marked[(z * count[1] + y) * count[0] + x] = 1;
        }
      }
    }
  }
  std::vector<std::uint32_t> blocks;
  for (std::uint32_t b = 0; b < marked.size(); ++b) {
    if (marked[b] != 0) {
      blocks.push_back(b);
    }
  }
  const Wendland kernel(p.spacing);
  std::vector<std::uint8_t> lone(p.size(), 0);
  const auto& held = grid.by_identity();
  for_each_particle(held.size(), [&](std::size_t k) {
    const std::uint32_t i = held[k];
    lone[i] = chosen[i] != 0 && sample(grid, p, kernel, p.position[i]).colour < lone_colour ? 1 : 0;
  });
  constexpr std::size_t parts = 4;
  const double step = p.spacing / static_cast<double>(parts), cell = step * step * step;
  std::vector<double> filled(blocks.size()), spheres(blocks.size());
  for_each_particle(blocks.size(), [&](std::size_t b) {
    const std::size_t x = blocks[b] % count[0], y = blocks[b] / count[0] % count[1],
                      z = blocks[b] / (count[0] * count[1]);
    double sum = 0, inside = 0;
    for (std::size_t k = 0; k < parts * parts * parts; ++k) {
      const auto at_part = [&](std::size_t d, std::size_t block, std::size_t part) {
        return lower[d] + step * (static_cast<double>(parts * block + part) + 0.5);
      };
      const Vector at{at_part(0, x, k % parts), at_part(1, y, k / parts % parts),
                      at_part(2, z, k / (parts * parts))};
      const Sample s = sample(grid, p, kernel, at);
      if (!std::isfinite(s.nearest) || chosen[s.owner] == 0) {
        continue;
      }
      const double ramp = std::clamp(0.5 + (s.colour - 0.5) / (kernel.slope() * step), 0.0, 1.0);
      const double radius = std::cbrt(3 * p.volume[s.owner] / (4 * std::numbers::pi));
      const bool sphere = s.nearest < radius * radius;
      sum += sphere && lone[s.owner] != 0 ? 1 : ramp;
      inside += sphere ? 1 : 0;
    }
    filled[b] = sum;
    spheres[b] = inside;
  });
  result.filled = cell * exact_sum(blocks.size(), [&](std::size_t b) { return filled[b]; }).total();
  result.union_of_spheres =
      cell * exact_sum(blocks.size(), [&](std::size_t b) { return spheres[b]; }).total();
  return result;
}

SurfaceHeight measure_height(const MetalGrid& grid, const Particles& p, double from, double to,
                             double centre, double width) {
  if (!(from < to) || !(width > 0)) {
    throw std::invalid_argument(
        "a surface is measured from a smaller x to a larger one, over a "
        "width above zero");
  }
  const Wendland kernel(p.spacing);
  const double step = 0.25 * p.spacing;
  const auto along = static_cast<std::size_t>(std::ceil((to - from) / (0.5 * p.spacing)));
  const auto across = static_cast<std::size_t>(std::ceil(width / (0.5 * p.spacing)));
  std::vector<double> height(along * across);
  for_each_particle(height.size(), [&](std::size_t c) {
    const auto share = [](std::size_t k, std::size_t n) {
      return (static_cast<double>(k) + 0.5) / static_cast<double>(n);
    };
    Vector at{from + (to - from) * share(c / across, along),
              centre + width * (share(c % across, across) - 0.5), 0};
    double above = 0;
    const auto levels = static_cast<std::size_t>((grid.upper()[2] - grid.lower()[2]) / step) + 8;
    height[c] = grid.lower()[2];
    for (std::size_t k = 0; k < levels; ++k) {
      at[2] = grid.upper()[2] + 4 * step - step * static_cast<double>(k);
      const double here = sample(grid, p, kernel, at).colour;
      if (here >= 0.5) {
        height[c] = at[2] + step * (here - 0.5) / (here - above);
        break;
      }
      above = here;
    }
  });
  SurfaceHeight result;
  result.columns = height.size();
  result.lowest_mean = result.deepest = std::numeric_limits<double>::infinity();
  std::size_t pits = 0;
  for (std::size_t a = 0; a < along; ++a) {
    double sum = 0;
    for (std::size_t b = 0; b < across; ++b) {
      const double h = height[a * across + b];
      sum += h;
      result.deepest = std::min(result.deepest, h);
      pits += h < -p.spacing ? 1 : 0;
    }
    result.lowest_mean = std::min(result.lowest_mean, sum / static_cast<double>(across));
    result.mean += sum;
  }
  result.mean /= static_cast<double>(height.size());
  result.share_of_pits = static_cast<double>(pits) / static_cast<double>(height.size());
  return result;
}

}  // namespace meltproof::solver

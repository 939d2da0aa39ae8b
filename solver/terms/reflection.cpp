// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/terms/reflection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "solver/particles/cell_grid.hpp"
#include "solver/particles/loops.hpp"

namespace meltproof::solver {
namespace {

/// Of what a ray began with: less than that is not followed.
constexpr double faintest = 1e-3;
/// A ray goes from hit to hit in steps of this many spacings, which are also half a cell.
constexpr double stride = 0.75;
/// A ray that grazes is turned away from the surface by at least this much.
constexpr double grazing = 0.05;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector along(const Vector& from, double t, const Vector& d) {
  return {from[0] + t * d[0], from[1] + t * d[1], from[2] + t * d[2]};
}
Vector unit(const Vector& v) {
  const double size = std::sqrt(dot(v, v));
  return {v[0] / size, v[1] / size, v[2] / size};
}

/// The metal around the beam, for rays to meet.
class Metal {
 public:
  Metal(const Particles& particles, const QuinticSpline& kernel)
      : position_(particles.position),
        wide_(1.5 * kernel.smoothing_length, particles.dimensions),
        spacing_(particles.spacing),
        grid_(Points{particles, no_images}, 2 * stride * particles.spacing, [&](std::size_t i) {
          const bool metal = particles.phase[i] != Phase::lost;
          if (metal) {
            box_.add(particles.position[i]);
          }
          return metal;
        }) {
    box_.grow(2 * spacing_);
  }

  struct Hit {
    std::uint32_t particle = 0;
    Vector at{};
  };

  /// Where a ray enters the ball of a particle; nothing where it passes by or begins inside.
  std::optional<double> entry(const Vector& from, const Vector& d, std::uint32_t j) const {
    const Vector& c = position_[j];
    const Vector to{c[0] - from[0], c[1] - from[1], c[2] - from[2]};
    const double closest = dot(to, d), radius = ray_radius * spacing_;
    const double aside = dot(to, to) - closest * closest;
    if (aside >= radius * radius) {
      return {};
    }
    const double t = closest - std::sqrt(radius * radius - aside);
    return t > 0 ? std::optional(t) : std::nullopt;
  }

  /// Outward, at a point of the surface. @param otherwise where nothing is near.
  Vector normal(const Vector& at, const Vector& otherwise) const {
    Vector sum{};
    const double support = wide_.support();
    near(at, 3, [&](std::uint32_t j) {
      const Vector& c = position_[j];
      const Vector to{c[0] - at[0], c[1] - at[1], c[2] - at[2]};
      const double r = std::sqrt(dot(to, to));
      if (r > 0 && r < support) {
        // The slope is negative, so this points away from the metal.
        sum = along(sum, wide_.slope(r) / r, to);
      }
    });
    const double size = std::sqrt(dot(sum, sum));
    return size > 0 ? Vector{sum[0] / size, sum[1] / size, sum[2] / size} : otherwise;
  }

  /// The first particle on the way of a ray that leaves the surface at `from` with normal n.
  std::optional<Hit> next(const Vector& from, const Vector& n, const Vector& d) const {
    const double step = stride * spacing_;
    const double own = 3 * spacing_;
    // Off the bumps of the lattice that it leaves.
    const Vector begin = along(from, 0.5 * spacing_, n);
    for (double t = 0;; t += step) {
      const Vector at = along(begin, t, d);
      if (!box_.holds(at)) {
        return {};
      }
      double first = std::numeric_limits<double>::infinity();
      std::uint32_t met = 0;
      near(at, 1, [&](std::uint32_t j) {
        const auto found = entry(begin, d, j);
        // Equally near ones: the smaller index, so that the order of looking does not matter.
        if (!found || *found > t + step || *found > first || (*found == first && j > met)) {
          return;
        }
        const Vector& c = position_[j];
        const Vector to{c[0] - from[0], c[1] - from[1], c[2] - from[2]};
        if (dot(to, to) < own * own && dot(to, n) < 0.25 * spacing_) {
          return;  // part of the surface that it leaves
        }
        first = *found;
        met = j;
      });
      if (first < std::numeric_limits<double>::infinity()) {
        return Hit{met, along(begin, first, d)};
      }
    }
  }

 private:
  template <class Visit>
  void near(const Vector& at, std::int64_t cells, const Visit& visit) const {
    std::array<std::int64_t, 3> low{}, high{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto c = static_cast<std::int64_t>(std::floor((at[k] - grid_.lower[k]) / grid_.size));
      low[k] = std::max<std::int64_t>(0, c - cells);
      high[k] = std::min(grid_.count[k] - 1, c + cells);
      if (low[k] > high[k]) {
        return;
      }
    }
    for (std::int64_t z = low[2]; z <= high[2]; ++z) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        const std::size_t from = grid_.cell({low[0], y, z}), to = grid_.cell({high[0], y, z});
        for (std::uint32_t k = grid_.first[from]; k < grid_.first[to + 1]; ++k) {
          visit(grid_.member[k]);
        }
      }
    }
  }

  static inline const std::vector<Ghost> no_images{};
  const std::vector<Vector>& position_;
  // The steps of a lattice turn normals by up to 14 degrees with the smoothing length of everything
  // else, on a wall of 60 degrees; by 9 with 1.5 times that, by 0.4 on one of 27.
  QuinticSpline wide_;
  double spacing_;
  Box box_;  // of all metal; before grid_, which fills it
  CellGrid grid_;
};

/// What a ray left where.
using Deposits = std::vector<std::pair<std::uint32_t, double>>;

Vector direction(const Laser& laser) {
  const Slant slant = laser.slant();
  return unit({slant.x, slant.y, -1});
}

/// All the ray's hits after the first. @param left of the light, W, after it.
void follow(const Metal& metal, Metal::Hit hit, Vector d, double left,
            const std::function<double(std::uint32_t)>& absorptivity, Deposits& deposits) {
  const double least = faintest * left;
  while (left > least) {
    const Vector n = metal.normal(hit.at, {-d[0], -d[1], -d[2]});
    d = unit(along(d, -2 * std::min(dot(d, n), -grazing), n));
    const auto next = metal.next(hit.at, n, d);
    if (!next) {
      return;
    }
    hit = *next;
    const double absorbed = absorptivity(hit.particle) * left;
    deposits.emplace_back(hit.particle, absorbed);
    left -= absorbed;
    if (absorbed <= 0) {
      return;  // a mirror: nothing will ever stay
    }
  }
}

}  // namespace

LaserBudget irradiate_with_reflections(const Laser& laser, double time,
                                       const SurfaceColumns& columns, const Particles& particles,
                                       const QuinticSpline& kernel,
                                       const std::function<double(std::uint32_t)>& absorptivity,
                                       std::vector<double>& power) {
  std::vector<FirstHit> hits;
  LaserBudget budget = irradiate(laser, time, columns, absorptivity, power, {}, &hits);
  if (hits.empty()) {
    return budget;
  }
  const Metal metal(particles, kernel);
  const Vector d = direction(laser);
  std::vector<Deposits> deposits(hits.size());
  for_each_particle(hits.size(), [&](std::size_t k) {
    const FirstHit& hit = hits[k];
    const Vector& p = particles.position[hit.particle];
    // On the column's axis, as high as the particle, then back along the beam to its ball.
    const double height = p[2];
    const Vector on_axis{hit.x - height * d[0] / -d[2], hit.y - height * d[1] / -d[2], height};
    const double far = 4 * particles.spacing;
    const Vector above = along(on_axis, -far, d);
    const double t = metal.entry(above, d, hit.particle).value_or(far);
    follow(metal, {hit.particle, along(above, t, d)}, d, hit.reflected, absorptivity, deposits[k]);
  });
  for (const Deposits& of_ray : deposits) {
    for (const auto& [particle, absorbed] : of_ray) {
      power[particle] += absorbed;
      budget.absorbed += absorbed;
      budget.reflected -= absorbed;
    }
  }
  return budget;
}

}  // namespace meltproof::solver

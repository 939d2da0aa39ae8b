// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/terms/reflection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "solver/particles/loops.hpp"
#include "solver/terms/reflection_metal.hpp"
#include "solver/terms/reflection_ranks.hpp"

namespace meltproof::solver {
namespace {

/// Of what a ray began with: less than that is not followed.
constexpr double faintest = 1e-3;
/// A ray that grazes is turned away from the surface by at least this much.
constexpr double grazing = 0.05;

/// Light of one column after its first hit, wherever that was.
struct Ray {
  double x, y;       // m, where the column's axis meets the plane z = 0
  Vector centre;     // m, of the particle
  double reflected;  // W
};

/// What a ray leaves where, and what it must know to go on.
struct Trace {
  std::vector<std::pair<std::uint32_t, double>> deposits;
  std::vector<std::uint64_t> wanted;
};

Vector direction(const Laser& laser) {
  const Slant slant = laser.slant();
  return unit({slant.x, slant.y, -1});
}

/// All the ray's hits after the first, at `at`. @param left of the light, W, after it.
void follow(const Metal& metal, Vector at, Vector d, double left,
            const std::function<double(std::uint32_t)>& absorptivity, Trace& trace) {
  const double least = faintest * left;
  while (left > least) {
    const Vector n = metal.normal(at, {-d[0], -d[1], -d[2]}, trace.wanted);
    if (!trace.wanted.empty()) {
      return;
    }
    d = unit(along(d, -2 * std::min(dot(d, n), -grazing), n));
    const auto next = metal.next(at, n, d, trace.wanted);
    if (!next) {
      return;
    }
    at = next->at;
    const double absorbed = absorptivity(next->particle) * left;
    trace.deposits.emplace_back(next->particle, absorbed);
    left -= absorbed;
    if (absorbed <= 0) {
      return;  // a mirror: nothing will ever stay
    }
  }
}

/// From the first hit on: on the column's axis, as high as the particle, then back along the beam
/// to its ball.
void trace(const Metal& metal, const Ray& ray, const Vector& d, double spacing,
           const std::function<double(std::uint32_t)>& absorptivity, Trace& found) {
  const double height = ray.centre[2];
  const Vector on_axis{ray.x - height * d[0] / -d[2], ray.y - height * d[1] / -d[2], height};
  const double far = 4 * spacing;
  const Vector above = along(on_axis, -far, d);
  const double t = metal.entry(above, d, ray.centre).value_or(far);
  found = {};
  follow(metal, along(above, t, d), d, ray.reflected, absorptivity, found);
}

/// The rays of all ranks in the order of columns.
std::vector<Ray> all_rays(const std::vector<FirstHit>& hits, const Particles& particles,
                          const Ranks& ranks) {
  std::vector<Ray> rays;
  for (const FirstHit& hit : hits) {
    rays.push_back({hit.x, hit.y, particles.position[hit.particle], hit.reflected});
  }
  rays = ranks.to_all(rays);
  std::sort(rays.begin(), rays.end(),
            [](const Ray& a, const Ray& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
  return rays;
}

}  // namespace

LaserBudget irradiate_with_reflections(const Laser& laser, double time,
                                       const SurfaceColumns& columns, const Particles& particles,
                                       const QuinticSpline& kernel,
                                       const std::function<double(std::uint32_t)>& absorptivity,
                                       std::vector<double>& power, const Ranks& ranks) {
  std::vector<FirstHit> hits;
  LaserBudget budget = irradiate(laser, time, columns, absorptivity, power, ranks, &hits);
  const std::vector<Ray> rays = all_rays(hits, particles, ranks);
  if (rays.empty()) {
    return budget;
  }
  const Box box = box_of_metal(particles, ranks);
  const Vector d = direction(laser);
  const auto add = [&](std::uint32_t particle, double absorbed, bool here) {
    if (here) {
      power[particle] += absorbed;
    }
    budget.absorbed += absorbed;
    budget.reflected -= absorbed;
  };
  if (ranks.alone()) {
    const Metal metal(particles, particles.size(), box, kernel, nullptr);
    std::vector<Trace> traces(rays.size());
    for_each_particle(rays.size(), [&](std::size_t k) {
      trace(metal, rays[k], d, particles.spacing, absorptivity, traces[k]);
    });
    for (const Trace& of_ray : traces) {
      for (const auto& [particle, absorbed] : of_ray.deposits) {
        add(particle, absorbed, true);
      }
    }
    return budget;
  }
  // Every rank traces its share of the rays; which metal they need shows as they go.
  SharedMetal shared(particles, absorptivity, box, ranks);
  const auto size = static_cast<std::size_t>(ranks.size()),
             own = static_cast<std::size_t>(ranks.rank());
  std::vector<std::size_t> unfinished;
  for (std::size_t k = own; k < rays.size(); k += size) {
    unfinished.push_back(k);
  }
  std::vector<Trace> traces(rays.size());
  const std::function<double(std::uint32_t)> share = [&](std::uint32_t j) {
    return shared.absorptivity(j);
  };
  for (;;) {
    const Metal metal(shared.particles(), shared.count(), box, kernel, &shared.blocks());
    for_each_particle(unfinished.size(), [&](std::size_t k) {
      trace(metal, rays[unfinished[k]], d, particles.spacing, share, traces[unfinished[k]]);
    });
    std::vector<std::uint64_t> wanted;
    std::erase_if(unfinished, [&](std::size_t k) {
      wanted.insert(wanted.end(), traces[k].wanted.begin(), traces[k].wanted.end());
      // Particles are numbered anew when others join them.
      shared.keep(k, traces[k].wanted.empty() ? traces[k].deposits : Deposits{});
      return traces[k].wanted.empty();
    });
    if (!shared.fetch(std::move(wanted))) {
      break;
    }
  }
  shared.each_deposit(add);
  return budget;
}

}  // namespace meltproof::solver

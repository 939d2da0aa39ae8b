// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/powder/powder_bed.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include "base/artifact.hpp"
#include "base/error.hpp"
#include "solver/powder/blend.hpp"

namespace meltproof::solver {
namespace {

/// A sphere on an edge of balance is dropped again; more often than this in a row only by a
/// mistake.
constexpr int most_attempts = 1000;

/// Everything that came to rest, in the order of dropping.
struct Heap {
  std::vector<Sphere> spheres;
  std::vector<std::array<int, 3>> supports;
  long long dropped_again = 0;
};

bool above_layer(const Sphere& sphere, const PowderSettings& settings) {
  const double height = sphere.centre.z() + (settings.blade == "top" ? sphere.radius : 0);
  return height > settings.layer_height;
}

/// Drops spheres until as many in a row as would cover the floor three times came to rest above the
/// layer: then no place in it is left that a falling sphere finds.
Heap fill(const PowderSettings& settings, const Blend& blend, Random& random,
          const std::function<void(double)>& progress) {
  const double largest = std::max(blend.base.largest(), blend.additive.largest()) / 2;
  SphereGrid grid(settings.length_x, settings.length_y, 2 * largest, settings.periodic);
  const double mean_square = (1 - blend.additive_number_fraction()) * blend.base.moment(2) +
                             blend.additive_number_fraction() * blend.additive.moment(2);
  const double floor_area = settings.length_x * settings.length_y;
  const auto enough =
      static_cast<long long>(std::max(50.0, 3 * floor_area / (std::numbers::pi / 4 * mean_square)));
  Heap heap;
  double volume = 0;
  for (long long above = 0; above < enough;) {
    const double radius = blend.draw(random) / 2;
    const double margin = settings.periodic ? 0 : radius;
    std::optional<Settled> settled;
    for (int attempt = 0; !settled; ++attempt) {
      if (attempt == most_attempts) {
        throw std::runtime_error(
            fmt::format("a sphere of {} um found no rest in {} attempts after {} others",
                        2e6 * radius, attempt, grid.spheres().size()));
      }
      heap.dropped_again += attempt > 0 ? 1 : 0;
      const double x = margin + random.uniform() * (settings.length_x - 2 * margin);
      const double y = margin + random.uniform() * (settings.length_y - 2 * margin);
      settled = drop_and_roll(grid, largest, radius, x, y);
    }
    grid.add(settled->sphere);
    heap.supports.push_back(settled->supports);
    above = above_layer(grid.spheres().back(), settings) ? above + 1 : 0;
    volume += sphere_volume_between(grid.spheres().back(), 0, settings.layer_height);
    if (progress) {
      progress(std::min(1.0, volume / (0.6 * floor_area * settings.layer_height)));
    }
  }
  heap.spheres = grid.spheres();
  return heap;
}

/// The blade: takes the spheres above the layer, and those that lose a support with them (a sphere
/// may lean against one whose centre is higher than its own).
std::vector<int> stay_in_layer(const Heap& heap, const PowderSettings& settings) {
  std::vector<int> place(heap.spheres.size(), -1);
  int count = 0;
  // A support was always dropped earlier, so one pass in the order of dropping is enough.
  for (std::size_t i = 0; i < heap.spheres.size(); ++i) {
    const bool carried = std::all_of(heap.supports[i].begin(), heap.supports[i].end(),
                                     [&place](int s) { return s < 0 || place[s] >= 0; });
    if (carried && !above_layer(heap.spheres[i], settings)) {
      place[i] = count++;
    }
  }
  return place;
}

/// Diameter below which a share q of the spheres' volume lies.
double volume_percentile(std::vector<double> radii, double q) {
  std::sort(radii.begin(), radii.end());
  const auto cube = [](double sum, double r) { return sum + r * r * r; };
  const double all = std::accumulate(radii.begin(), radii.end(), 0.0, cube);
  double below = 0;
  for (const double r : radii) {
    below += r * r * r;
    if (below >= q * all) {
      return 2 * r;
    }
  }
  return radii.empty() ? 0 : 2 * radii.back();
}

std::vector<std::int32_t> coordination_of(const std::vector<Sphere>& spheres,
                                          const PowderSettings& settings) {
  double largest = 0;
  for (const Sphere& sphere : spheres) {
    largest = std::max(largest, sphere.radius);
  }
  std::vector<std::int32_t> coordination(spheres.size(), 0);
  if (spheres.empty()) {
    return coordination;
  }
  SphereGrid grid(settings.length_x, settings.length_y, 2 * largest, settings.periodic);
  for (const Sphere& sphere : spheres) {
    grid.add(sphere);
  }
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    grid.visit_near(spheres[i].centre, spheres[i].radius + largest,
                    [&](const SphereGrid::Near& near) {
                      const double sum = spheres[i].radius + near.radius;
                      const bool itself = near.index == static_cast<int>(i);
                      if (!itself && (near.centre - spheres[i].centre).norm() < (1 + 1e-8) * sum) {
                        ++coordination[i];
                      }
                    });
  }
  return coordination;
}

}  // namespace

double sphere_volume_between(const Sphere& sphere, double low, double high) {
  const double r = sphere.radius;
  const double a = std::clamp(low - sphere.centre.z(), -r, r);
  const double b = std::clamp(high - sphere.centre.z(), -r, r);
  return std::numbers::pi * (r * r * (b - a) - (b * b * b - a * a * a) / 3);
}

PowderBed generate(const PowderSettings& settings, const std::function<void(double)>& progress) {
  check(settings);
  const Blend blend{{settings.base.size, "base"},
                    {settings.additive.size, "additive"},
                    settings.base.density,
                    settings.additive.density,
                    settings.additive_mass_fraction};
  Random random(static_cast<std::uint64_t>(settings.seed));
  const Heap heap = fill(settings, blend, random, progress);
  const std::vector<int> place = stay_in_layer(heap, settings);

  PowderBed bed;
  bed.dropped = static_cast<long long>(heap.spheres.size());
  bed.dropped_again = heap.dropped_again;
  std::vector<double> radii;
  double volume = 0;
  for (std::size_t i = 0; i < heap.spheres.size(); ++i) {
    if (place[i] < 0) {
      continue;
    }
    bed.spheres.push_back(heap.spheres[i]);
    auto supports = heap.supports[i];
    for (int& support : supports) {
      support = support < 0 ? support : place[support];
    }
    bed.supports.push_back(supports);
    radii.push_back(heap.spheres[i].radius);
    volume += sphere_volume_between(heap.spheres[i], 0, settings.layer_height);
  }
  bed.material = assign_materials(bed.spheres, blend, random);
  bed.additive_mass_fraction = additive_mass_fraction(bed.spheres, bed.material, blend);
  bed.coordination = coordination_of(bed.spheres, settings);
  const auto count = static_cast<double>(std::max<std::size_t>(bed.spheres.size(), 1));
  bed.mean_coordination =
      std::accumulate(bed.coordination.begin(), bed.coordination.end(), 0.0) / count;
  bed.packing_density = volume / (settings.length_x * settings.length_y * settings.layer_height);
  bed.d10 = volume_percentile(radii, 0.1);
  bed.d50 = volume_percentile(radii, 0.5);
  bed.d90 = volume_percentile(radii, 0.9);
  bed.lower = {settings.origin_x, settings.origin_y, 0};
  bed.upper =
      bed.lower + Eigen::Vector3d(settings.length_x, settings.length_y, settings.layer_height);
  for (Sphere& sphere : bed.spheres) {
    sphere.centre += bed.lower;
  }
  return bed;
}

void write_powder_bed(const std::filesystem::path& path, const PowderBed& bed,
                      const Provenance& provenance) {
  const std::size_t n = bed.spheres.size();
  std::vector<double> centre, radius;
  for (const Sphere& sphere : bed.spheres) {
    centre.insert(centre.end(), sphere.centre.begin(), sphere.centre.end());
    radius.push_back(sphere.radius);
  }
  ArtifactWriter file(path, "meltproof powder bed");
  file.write("spheres/centre", std::span<const double>(centre), {n, 3}, "m",
             "centre of each sphere; z = 0 is the surface of the plate");
  file.write("spheres/radius", std::span<const double>(radius), {n}, "m", "radius of each sphere");
  file.write("spheres/material", std::span<const std::int32_t>(bed.material), {n}, "1",
             "0 base powder, 1 additive");
  file.write("spheres/coordination", std::span<const std::int32_t>(bed.coordination), {n}, "1",
             "number of touching spheres; floor and walls are not counted");
  file.write("box/lower", std::span<const double>(bed.lower.data(), 3), {3}, "m",
             "lower corner of the box; z = 0 is the surface of the plate");
  file.write("box/upper", std::span<const double>(bed.upper.data(), 3), {3}, "m",
             "upper corner of the box; z is the layer height");
  file.write("packing_density", bed.packing_density, "1",
             "sphere volume between the plate and the layer height over the volume of the layer");
  file.write("mean_coordination", bed.mean_coordination, "1", "mean of spheres/coordination");
  file.write("additive_mass_fraction", bed.additive_mass_fraction, "1",
             "mass of the additive over the mass of all spheres in the bed");
  file.write("d10", bed.d10, "m", "10 % of the spheres' volume is in smaller diameters");
  file.write("d50", bed.d50, "m", "50 % of the spheres' volume is in smaller diameters");
  file.write("d90", bed.d90, "m", "90 % of the spheres' volume is in smaller diameters");
  file.commit(provenance);
}

}  // namespace meltproof::solver

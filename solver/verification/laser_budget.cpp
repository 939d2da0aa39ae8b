// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/verification/laser_budget.hpp"

#include <algorithm>
#include <cmath>

#include "solver/powder/powder_bed.hpp"
#include "solver/terms/laser.hpp"
#include "solver/verification/setup.hpp"

namespace meltproof::solver {
namespace {

constexpr double length = 400e-6, width = 200e-6, plate_depth = 60e-6;
constexpr double steel = 0.4, aluminium = 0.09;  // absorptivities, Tables A1 and A2

PowderSettings bed_settings() {
  PowderSettings bed;
  bed.length_x = length;
  bed.length_y = width;
  bed.layer_height = 40e-6;
  bed.additive_mass_fraction = 0.05;
  bed.base.size = {.d50 = 26e-6, .d10 = 18e-6, .d90 = 38e-6};
  bed.additive.size = bed.base.size;
  bed.seed = 3;
  return bed;
}

/// Particles on one lattice: the plate, and every cell whose centre lies inside a grain.
Particles make_bed(const PowderBed& bed, double spacing, std::vector<double>& absorptivity) {
  Particles particles;
  particles.spacing = spacing;
  const double volume = spacing * spacing * spacing;
  const auto add = [&](const Vector& at, double share, Origin origin) {
    particles.add(static_cast<std::int64_t>(particles.size()), at, PlainMatter::density * volume,
                  volume, 0, 0, origin);
    absorptivity.push_back(share);
  };
  const auto centre = [spacing](std::int64_t i) {
    return (static_cast<double>(i) + 0.5) * spacing;
  };
  const auto count = [spacing](double l) {
    return static_cast<std::int64_t>(std::llround(l / spacing));
  };
  const std::int64_t top = count(bed.upper[2] + 60e-6);
  for (std::int64_t k = -count(plate_depth); k < top; ++k) {
    for (std::int64_t j = 0; j < count(width); ++j) {
      for (std::int64_t i = 0; i < count(length); ++i) {
        const Vector at{centre(i), centre(j), centre(k)};
        if (k < 0) {
          add(at, steel, Origin::plate);
          continue;
        }
        for (std::size_t s = 0; s < bed.spheres.size(); ++s) {
          const Eigen::Vector3d from = Eigen::Vector3d(at[0], at[1], at[2]) - bed.spheres[s].centre;
          if (from.norm() < bed.spheres[s].radius) {
            const bool additive = bed.material[s] == 1;
            add(at, additive ? aluminium : steel,
                additive ? Origin::additive_powder : Origin::base_powder);
            break;
          }
        }
      }
    }
  }
  return particles;
}

}  // namespace

VerificationRun run_laser_budget(const VerificationCase& c, double spacing) {
  std::vector<double> absorptivity;
  const PowderBed bed = generate(bed_settings());
  const Particles particles = make_bed(bed, spacing, absorptivity);
  VerificationRun run;
  run.particles = particles.size();
  run.value_name = "absorbed share";
  std::size_t shadowed = 0;
  for (int place = 0; place < 16; ++place) {
    const Laser laser{.power = c.power,
                      .radius = c.radius,
                      .speed = 1,
                      .start_x = -50e-6 + 500e-6 * place / 15,
                      .y = width / 2 + 3.7e-6,
                      .exposure = 1,
                      .incidence = c.incidence_angle,
                      .azimuth = 0.7 * place};
    const SurfaceColumns columns =
        find_surface(particles, {0, 0, 0}, {length, width, 0}, laser.slant());
    std::vector<double> power(particles.size(), 0.0);
    const LaserBudget budget = irradiate(
        laser, 0, columns, [&](std::uint32_t i) { return absorptivity[i]; }, power);
    double held = 0;
    for (const double p : power) {
      held += p;
    }
    run.error =
        std::max({run.error,
                  std::abs(budget.absorbed + budget.reflected + budget.missed - c.power) / c.power,
                  std::abs(held - budget.absorbed) / c.power});
    run.position.push_back(laser.start_x);
    run.value.push_back(budget.absorbed / c.power);
    run.exact.push_back(steel);
    ++run.steps;
    for (std::size_t i = 0; i < power.size(); ++i) {
      shadowed += power[i] == 0 && particles.position[i][2] > -spacing ? 1 : 0;
    }
    if (budget.absorbed > steel * (c.power - budget.missed) * (1 + 1e-12)) {
      run.broken.emplace_back("more was absorbed than steel alone would absorb");
    }
  }
  run.extra = {{"grains", bed.spheres.size()},
               {"packing_density", bed.packing_density},
               {"largest_absorbed_share", *std::max_element(run.value.begin(), run.value.end())}};
  if (bed.spheres.size() < 50 || shadowed == 0) {
    run.broken.emplace_back("the bed does not shadow anything: it is no powder bed");
  }
  return run;
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "base/artifact.hpp"
#include "base/error.hpp"
#include "solver/case/track_case.hpp"

namespace meltproof::solver {
namespace {

using Cell = std::array<std::int64_t, 3>;

/// How much of a lattice cell the grains fill, in sub-points, and how much of that is additive.
struct Fill {
  int all = 0, additive = 0;
};

constexpr int sub_points = 8;  // a side

/// Counts the sub-points of every cell above the plate that lie inside a grain.
std::map<Cell, Fill> overlap(const ArtifactReader& bed, const Domain& domain, double spacing) {
  const auto centre = bed.read<double>("spheres/centre");
  const auto radius = bed.read<double>("spheres/radius");
  const auto material = bed.read<std::int32_t>("spheres/material");
  std::map<Cell, Fill> cells;
  const double step = spacing / sub_points;
  for (std::size_t s = 0; s < radius.values.size(); ++s) {
    const double r = radius.values[s];
    const double* c = &centre.values[3 * s];
    // Sub-points are counted on one grid of the step, whose cells of eight a side are the
    // lattice's.
    std::array<std::int64_t, 3> low{}, high{};
    for (std::size_t d = 0; d < 3; ++d) {
      const double edge = d == 2 ? 0 : domain.lower[d];
      low[d] = std::max<std::int64_t>(
          0, static_cast<std::int64_t>(std::floor((c[d] - r - edge) / step)));
      high[d] = static_cast<std::int64_t>(std::ceil((c[d] + r - edge) / step));
      if (d < 2) {
        high[d] = std::min<std::int64_t>(high[d], std::llround((domain.upper[d] - edge) / step));
      }
    }
    for (std::int64_t k = low[2]; k < high[2]; ++k) {
      for (std::int64_t j = low[1]; j < high[1]; ++j) {
        for (std::int64_t i = low[0]; i < high[0]; ++i) {
          const double x = domain.lower[0] + (static_cast<double>(i) + 0.5) * step - c[0];
          const double y = domain.lower[1] + (static_cast<double>(j) + 0.5) * step - c[1];
          const double z = (static_cast<double>(k) + 0.5) * step - c[2];
          if (x * x + y * y + z * z < r * r) {
            Fill& fill = cells[{i / sub_points, j / sub_points, k / sub_points}];
            ++fill.all;
            fill.additive += material.values[s] == 1 ? 1 : 0;
          }
        }
      }
    }
  }
  return cells;
}

}  // namespace

Discretisation discretise(const TrackCase& t, const Mixture& mixture) {
  Discretisation result;
  const double dx = t.spacing;
  const auto whole = [dx](double length) {
    return std::max<std::int64_t>(1, std::llround(length / dx));
  };
  const std::int64_t nx = whole(t.before + t.speed * t.exposure + t.behind), nz = whole(t.depth);
  const std::int64_t ny =
      2 * whole(t.width / 2);  // even, so that the track's line is a plane of symmetry
  Domain& domain = result.domain;
  domain.lower = {-dx * static_cast<double>(whole(t.before)), -dx * static_cast<double>(ny) / 2,
                  -dx * static_cast<double>(nz)};
  domain.upper = {domain.lower[0] + dx * static_cast<double>(nx), -domain.lower[1], 0};

  Particles& particles = result.particles;
  particles.spacing = dx;
  const double volume = dx * dx * dx;
  std::int64_t identity = 0;
  const auto place = [&](const Cell& cell, double bottom, double concentration, Origin origin) {
    const Vector at{domain.lower[0] + (static_cast<double>(cell[0]) + 0.5) * dx,
                    domain.lower[1] + (static_cast<double>(cell[1]) + 0.5) * dx,
                    bottom + (static_cast<double>(cell[2]) + 0.5) * dx};
    particles.add(identity++, at, mixture.density(concentration) * volume, volume,
                  mixture.enthalpy(t.initial_temperature, concentration), concentration, origin);
  };
  for (std::int64_t k = 0; k < nz; ++k) {
    for (std::int64_t j = 0; j < ny; ++j) {
      for (std::int64_t i = 0; i < nx; ++i) {
        place({i, j, k}, domain.lower[2], 0, Origin::plate);
      }
    }
  }
  if (t.surface == "bare") {
    return result;
  }
  if (t.bed.empty()) {
    throw InputError(
        "powder.bed: this case has powder on the plate, but no bed was named: make one with "
        "meltproof-powder and give it by --powder, or set powder.surface = \"bare\"");
  }
  const ArtifactReader bed(t.bed, "meltproof powder bed");
  const auto lower = bed.read<double>("box/lower").values,
             upper = bed.read<double>("box/upper").values;
  for (std::size_t d = 0; d < 2; ++d) {
    if (lower[d] > domain.lower[d] + dx || upper[d] < domain.upper[d] - dx) {
      throw InputError(fmt::format(
          "{}: the bed covers {:.0f} to {:.0f} um along {}, the track needs {:.0f} to {:.0f} "
          "um: make the bed with a box of at least that size",
          t.bed.string(), 1e6 * lower[d], 1e6 * upper[d], d == 0 ? "x" : "y", 1e6 * domain.lower[d],
          1e6 * domain.upper[d]));
    }
  }
  result.bed_additive_mass_fraction = bed.scalar("additive_mass_fraction");
  const auto cells = overlap(bed, domain, dx);
  std::vector<std::pair<Cell, Fill>> fullest(cells.begin(), cells.end());
  std::int64_t points = 0, additive_points = 0;
  for (const auto& [cell, fill] : fullest) {
    points += fill.all;
    additive_points += fill.additive;
  }
  constexpr double cell_points = sub_points * sub_points * sub_points;
  const auto particles_for = [](std::int64_t n) {
    return std::llround(static_cast<double>(n) / cell_points);
  };
  const auto additive_count = static_cast<std::ptrdiff_t>(particles_for(additive_points));
  const auto base_count = static_cast<std::ptrdiff_t>(particles_for(points - additive_points));
  // Cells of equal fill keep the order of the map, that is of their place.
  const auto split = fullest.begin() + additive_count;
  std::stable_sort(fullest.begin(), fullest.end(), [](const auto& a, const auto& b) {
    return a.second.additive > b.second.additive;
  });
  std::sort(fullest.begin(), split, [](const auto& a, const auto& b) { return a.first < b.first; });
  std::stable_sort(split, fullest.end(),
                   [](const auto& a, const auto& b) { return a.second.all > b.second.all; });
  for (auto at = fullest.begin(); at < std::min(fullest.end(), split + base_count); ++at) {
    const bool additive = at < split;
    place(at->first, 0, additive ? 1 : 0, additive ? Origin::additive_powder : Origin::base_powder);
    domain.upper[2] = std::max(domain.upper[2], dx * static_cast<double>(at->first[2] + 1));
  }
  result.powder_volume = static_cast<double>(points) / cell_points * volume;
  result.powder_volume_error =
      static_cast<double>(additive_count + base_count) * volume / result.powder_volume - 1;
  const double additive_mass = mixture.density(1) * static_cast<double>(additive_count);
  const double powder_mass = additive_mass + mixture.density(0) * static_cast<double>(base_count);
  result.additive_mass_fraction = powder_mass > 0 ? additive_mass / powder_mass : 0;
  return result;
}

}  // namespace meltproof::solver

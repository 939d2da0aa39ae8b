// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/solidification_csv.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "base/artifact.hpp"
#include "base/error.hpp"
#include "solver/output/metal_grid.hpp"
#include "solver/particles/loops.hpp"

namespace meltproof::solver {
namespace {

constexpr double most_places = 2e8;
constexpr double reach_spacings = 2, nearest_spacings = 0.9;
// Freezing time, time spent molten (not the melting time: so the one never comes before the other),
// cooling rate, gradient.
constexpr std::size_t values = 4;
using Values = Eigen::Matrix<double, 1, values>;

Values values_of(const Particles& p, std::uint32_t i) {
  return Values(p.freeze_time[i], p.freeze_time[i] - p.melt_time[i], p.cooling_rate[i],
                p.freeze_gradient[i]);
}

/// The weighted linear fit, or the weighted mean where a fit is not possible.
Values fit(const MetalGrid& grid, const Particles& p, const Vector& at) {
  const double reach = reach_spacings * p.spacing;
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 4, values> right = Eigen::Matrix<double, 4, values>::Zero();
  Values least = Values::Constant(std::numeric_limits<double>::infinity()), most = -least;
  std::size_t count = 0;
  grid.for_each_within(at, reach, [&](std::uint32_t j, double r2) {
    if (!is_frozen(p, j)) {
      return;
    }
    const double q = std::sqrt(r2) / reach, s = (1 - q) * (1 - q);
    // Places in units of the spacing, so that the matrix is well scaled.
    const Eigen::Vector4d basis(1, (p.position[j][0] - at[0]) / p.spacing,
                                (p.position[j][1] - at[1]) / p.spacing,
                                (p.position[j][2] - at[2]) / p.spacing);
    const double weight = s * s * (1 + 4 * q);
    const Values v = values_of(p, j);
    normal += weight * basis * basis.transpose();
    right += weight * basis * v;
    least = least.cwiseMin(v);
    most = most.cwiseMax(v);
    ++count;
  });
  Values mean = right.row(0) / normal(0, 0);
  if (count < 8) {
    return mean;
  }
  const Eigen::ColPivHouseholderQR<Eigen::Matrix4d> solver(normal);
  if (solver.rank() < 4 || std::abs(solver.matrixR()(3, 3)) < 1e-3 * normal(0, 0)) {
    return mean;
  }
  const Values linear = solver.solve(right).row(0);
  return linear.cwiseMax(least).cwiseMin(most);
}

}  // namespace

bool is_frozen(const Particles& p, std::size_t i) {
  return p.phase[i] == Phase::solid && p.melt_time[i] >= 0 && p.freeze_time[i] > p.melt_time[i] &&
         p.cooling_rate[i] > 0 && p.freeze_gradient[i] > 0;
}

FrozenTrack read_frozen_track(const std::filesystem::path& path) {
  const ArtifactReader run(path, "meltproof run");
  std::string last;
  if (run.has("snapshots")) {
    for (const auto& name : run.names("snapshots")) {
      last = std::max(last, name);
    }
  }
  const std::string group = "snapshots/" + last + "/";
  if (last.empty() || !run.has(group + "freeze_gradient")) {
    throw InputError(fmt::format(
        "{} {}: run meltproof-solve again to get times and rates of melting and freezing",
        path.string(),
        last.empty() ? "holds no snapshots"
                     : "was written by a version that did not record solidification"));
  }
  FrozenTrack track;
  track.time = run.scalar(group + "time");
  Particles& p = track.particles;
  p.spacing = run.scalar("spacing");
  p.identity = run.read<std::int64_t>(group + "identity").values;
  const std::size_t n = p.identity.size();
  const auto position = run.read<double>(group + "position").values;
  const auto phase = run.read<std::uint8_t>(group + "phase").values;
  p.melt_time = run.read<double>(group + "melt_time").values;
  p.freeze_time = run.read<double>(group + "freeze_time").values;
  p.cooling_rate = run.read<double>(group + "cooling_rate").values;
  p.freeze_gradient = run.read<double>(group + "freeze_gradient").values;
  p.position.resize(n);
  p.phase.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    p.position[i] = {position[3 * i], position[3 * i + 1], position[3 * i + 2]};
    p.phase[i] = static_cast<Phase>(phase[i]);
    track.frozen += is_frozen(p, i) ? 1 : 0;
    track.still_liquid += p.phase[i] == Phase::liquid ? 1 : 0;
  }
  return track;
}

std::vector<FrozenPoint> interpolate(const FrozenTrack& track, double cell) {
  const Particles& p = track.particles;
  if (!(cell > 0)) {
    throw InputError(fmt::format(
        "the cell of the grid is {} m: give a length above zero, for example --cell \"2.5 um\"",
        cell));
  }
  const MetalGrid grid(p);
  Vector lower = MetalGrid::everywhere(1), upper = MetalGrid::everywhere(-1);
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t d = 0; d < 3 && is_frozen(p, i); ++d) {
      lower[d] = std::min(lower[d], p.position[i][d] - nearest_spacings * p.spacing);
      upper[d] = std::max(upper[d], p.position[i][d] + nearest_spacings * p.spacing);
    }
  }
  std::vector<FrozenPoint> result;
  if (!(lower[0] < upper[0])) {
    return result;
  }
  std::array<long, 3> first{}, count{};
  double places = 1;
  for (std::size_t d = 0; d < 3; ++d) {
    places *= (upper[d] - lower[d]) / cell + 1;
    if (!(places < most_places)) {
      throw InputError(
          fmt::format("a cell of {:.3g} um would make a grid of over {:.0e} places; the particles "
                      "are {:.3g} um apart, a tenth of which is finer than they can tell",
                      1e6 * cell, most_places, 1e6 * p.spacing));
    }
    first[d] = static_cast<long>(std::ceil(lower[d] / cell));
    count[d] = static_cast<long>(std::floor(upper[d] / cell)) - first[d] + 1;
  }
  const auto rows = static_cast<std::size_t>(std::max(0L, count[1] * count[2]));
  std::vector<std::vector<FrozenPoint>> row(rows);
  for_each_particle(rows, [&](std::size_t r) {
    const long y = first[1] + static_cast<long>(r) % count[1],
               z = first[2] + static_cast<long>(r) / count[1];
    for (long x = first[0]; x < first[0] + count[0]; ++x) {
      FrozenPoint point;
      point.at = {static_cast<double>(x) * cell, static_cast<double>(y) * cell,
                  static_cast<double>(z) * cell};
      double nearest = std::numeric_limits<double>::infinity();
      bool frozen = false;
      grid.for_each_within(point.at, nearest_spacings * p.spacing, [&](std::uint32_t j, double r2) {
        if (r2 < nearest) {
          nearest = r2;
          frozen = is_frozen(p, j);
        }
      });
      if (frozen) {
        const Values v = fit(grid, p, point.at);
        point.freeze_time = v[0];
        point.melt_time = std::max(0.0, v[0] - v[1]);
        point.cooling_rate = v[2];
        point.gradient = v[3];
        row[r].push_back(point);
      }
    }
  });
  for (const auto& part : row) {
    result.insert(result.end(), part.begin(), part.end());
  }
  return result;
}

std::string exaca_csv(const std::vector<FrozenPoint>& points) {
  std::string out = "x,y,z,tm,ts,cr\n";
  for (const auto& p : points) {
    out += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.6g}\n", p.at[0], p.at[1], p.at[2],
                       p.melt_time, p.freeze_time, p.cooling_rate);
  }
  return out;
}

std::string gradient_csv(const std::vector<FrozenPoint>& points) {
  std::string out = "x,y,z,ts,cr,g,v\n";
  for (const auto& p : points) {
    out += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.6g},{:.6g},{:.6g}\n", p.at[0], p.at[1],
                       p.at[2], p.freeze_time, p.cooling_rate, p.gradient, p.velocity());
  }
  return out;
}

}  // namespace meltproof::solver

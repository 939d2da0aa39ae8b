// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/terms/laser.hpp"

#include <cmath>
#include <numbers>

namespace meltproof::solver {
namespace {

/// Shares of the beam's power in slices of `width` from `first` on, along one axis, centred at
/// `centre`. A Gaussian separates, so a column's share is the product of its slices along x and y.
std::vector<double> slices(double centre, double radius, double first, double width,
                           std::size_t count) {
  std::vector<double> share(count);
  const double scale = std::numbers::sqrt2 / radius;
  double edge = std::erf(scale * (first - centre));
  for (std::size_t i = 0; i < count; ++i) {
    const double next = std::erf(scale * (first + static_cast<double>(i + 1) * width - centre));
    share[i] = (next - edge) / 2;
    edge = next;
  }
  double sum = 0;
  for (const double s : share) {
    sum += s;
  }
  for (double& s : share) {
    s /= sum;
  }
  return share;
}

/// A square of columns that holds the beam's footprint, and the share of the power in each.
struct Footprint {
  std::int64_t first_x = 0, first_y = 0;
  std::size_t count = 0;
  std::vector<double> share;  ///< row-major [y][x]; their sum is one
};

/// Places the square; the shares are still zero.
Footprint around(const Laser& laser, double x, double reach, const SurfaceColumns& columns) {
  Footprint f;
  f.count = static_cast<std::size_t>(2 * std::ceil(reach / columns.width)) + 1;
  f.first_x = static_cast<std::int64_t>(std::floor((x - reach - columns.lower_x) / columns.width));
  f.first_y =
      static_cast<std::int64_t>(std::floor((laser.y - reach - columns.lower_y) / columns.width));
  f.share.resize(f.count * f.count);
  return f;
}

Footprint vertical_footprint(const Laser& laser, double x, const SurfaceColumns& columns) {
  Footprint f = around(laser, x, 3 * laser.radius, columns);
  const auto lower = [&](double edge, std::int64_t first) {
    return edge + static_cast<double>(first) * columns.width;
  };
  const auto share_x =
      slices(x, laser.radius, lower(columns.lower_x, f.first_x), columns.width, f.count);
  const auto share_y =
      slices(laser.y, laser.radius, lower(columns.lower_y, f.first_y), columns.width, f.count);
  for (std::size_t j = 0; j < f.count; ++j) {
    for (std::size_t i = 0; i < f.count; ++i) {
      f.share[j * f.count + i] = share_x[i] * share_y[j];
    }
  }
  return f;
}

Footprint inclined_footprint(const Laser& laser, double x, const SurfaceColumns& columns) {
  Footprint f = around(laser, x, 3 * laser.radius / std::cos(laser.incidence), columns);
  const double along_x = std::cos(laser.azimuth), along_y = std::sin(laser.azimuth);
  const double shortening = std::cos(laser.incidence);
  // Distance from the axis: lengths along the azimuth are seen foreshortened.
  const auto intensity = [&](double dx, double dy) {
    const double u = (dx * along_x + dy * along_y) * shortening, w = dy * along_x - dx * along_y;
    return std::exp(-2 * (u * u + w * w) / (laser.radius * laser.radius));
  };
  const double node = std::sqrt(0.6) / 2;
  const double nodes[3] = {-node, 0, node}, weights[3] = {5. / 18, 8. / 18, 5. / 18};
  double sum = 0;
  for (std::size_t j = 0; j < f.count; ++j) {
    for (std::size_t i = 0; i < f.count; ++i) {
      double& share = f.share[j * f.count + i];
      for (int b = 0; b < 3; ++b) {
        for (int a = 0; a < 3; ++a) {
          const double column_x = static_cast<double>(f.first_x + static_cast<std::int64_t>(i));
          const double column_y = static_cast<double>(f.first_y + static_cast<std::int64_t>(j));
          share +=
              weights[a] * weights[b] *
              intensity(columns.lower_x + (column_x + 0.5 + nodes[a]) * columns.width - x,
                        columns.lower_y + (column_y + 0.5 + nodes[b]) * columns.width - laser.y);
        }
      }
      sum += share;
    }
  }
  for (double& share : f.share) {
    share /= sum;
  }
  return f;
}

}  // namespace

LaserBudget irradiate(const Laser& laser, double time, const SurfaceColumns& columns,
                      const std::function<double(std::uint32_t)>& absorptivity,
                      std::vector<double>& power, const Ranks& ranks, std::vector<FirstHit>* hits) {
  LaserBudget budget;
  if (!laser.on(time) || laser.power <= 0) {
    return budget;
  }
  const Footprint f = laser.incidence == 0 ? vertical_footprint(laser, laser.x(time), columns)
                                           : inclined_footprint(laser, laser.x(time), columns);
  // Each column is met on one rank at most, so largest values join them without rounding; then all
  // ranks add the columns up in the same order.
  std::vector<double> absorbed(f.share.size(), 0.0);
  std::vector<std::uint8_t> met(f.share.size(), 0);
  for (std::size_t j = 0; j < f.count; ++j) {
    const std::int64_t iy = f.first_y + static_cast<std::int64_t>(j);
    const bool inside_y = iy >= 0 && iy < static_cast<std::int64_t>(columns.count_y);
    for (std::size_t i = 0; i < f.count; ++i) {
      const std::int64_t ix = f.first_x + static_cast<std::int64_t>(i);
      const bool inside = inside_y && ix >= 0 && ix < static_cast<std::int64_t>(columns.count_x);
      const std::uint32_t top =
          inside ? columns.at(static_cast<std::size_t>(ix), static_cast<std::size_t>(iy))
                 : SurfaceColumns::none;
      if (top == SurfaceColumns::none || top == SurfaceColumns::elsewhere) {
        continue;
      }
      const std::size_t column = j * f.count + i;
      met[column] = 1;
      absorbed[column] = absorptivity(top) * (laser.power * f.share[column]);
      power[top] += absorbed[column];
      if (hits != nullptr) {
        const double axis_x = columns.lower_x + (static_cast<double>(ix) + 0.5) * columns.width;
        const double axis_y = columns.lower_y + (static_cast<double>(iy) + 0.5) * columns.width;
        hits->push_back({top, axis_x, axis_y, laser.power * f.share[column] - absorbed[column]});
      }
    }
  }
  ranks.largest(absorbed);
  ranks.largest(std::span(met));
  for (std::size_t column = 0; column < met.size(); ++column) {
    const double incident = laser.power * f.share[column];
    if (met[column] == 0) {
      budget.missed += incident;
    } else {
      budget.absorbed += absorbed[column];
      budget.reflected += incident - absorbed[column];
    }
  }
  return budget;
}

}  // namespace meltproof::solver

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

}  // namespace

LaserBudget irradiate(const Laser& laser, double time, const SurfaceColumns& columns,
                      const std::vector<double>& absorptivity, std::vector<double>& power) {
  LaserBudget budget;
  if (!laser.on(time) || laser.power <= 0) {
    return budget;
  }
  const double reach = 3 * laser.radius, width = columns.width;
  const auto count = static_cast<std::size_t>(2 * std::ceil(reach / width)) + 1;
  const auto first_x =
      static_cast<std::int64_t>(std::floor((laser.x(time) - reach - columns.lower_x) / width));
  const auto first_y =
      static_cast<std::int64_t>(std::floor((laser.y - reach - columns.lower_y) / width));
  const auto share_x = slices(laser.x(time), laser.radius,
                              columns.lower_x + static_cast<double>(first_x) * width, width, count);
  const auto share_y = slices(laser.y, laser.radius,
                              columns.lower_y + static_cast<double>(first_y) * width, width, count);
  // One thread, always the same order: the beam covers a few thousand columns at most.
  for (std::size_t j = 0; j < count; ++j) {
    const std::int64_t iy = first_y + static_cast<std::int64_t>(j);
    const bool inside_y = iy >= 0 && iy < static_cast<std::int64_t>(columns.count_y);
    for (std::size_t i = 0; i < count; ++i) {
      const double incident = laser.power * share_x[i] * share_y[j];
      const std::int64_t ix = first_x + static_cast<std::int64_t>(i);
      const bool inside = inside_y && ix >= 0 && ix < static_cast<std::int64_t>(columns.count_x);
      const std::uint32_t top =
          inside ? columns.at(static_cast<std::size_t>(ix), static_cast<std::size_t>(iy))
                 : SurfaceColumns::none;
      if (top == SurfaceColumns::none) {
        budget.missed += incident;
        continue;
      }
      const double absorbed = absorptivity[top] * incident;
      power[top] += absorbed;
      budget.absorbed += absorbed;
      budget.reflected += incident - absorbed;
    }
  }
  return budget;
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/particles/particles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace meltproof::solver {
namespace {

/// Spreads the lowest 21 bits so that two zero bits stand between each.
std::uint64_t spread(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32U) & 0x1f00000000ffff;
  x = (x | x << 16U) & 0x1f0000ff0000ff;
  x = (x | x << 8U) & 0x100f00f00f00f00f;
  x = (x | x << 4U) & 0x10c30c30c30c30c3;
  x = (x | x << 2U) & 0x1249249249249249;
  return x;
}

template <class T>
void permute(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
  std::vector<T> sorted(values.size());
  std::transform(order.begin(), order.end(), sorted.begin(),
                 [&](std::uint32_t i) { return values[i]; });
  values = std::move(sorted);
}

}  // namespace

void Particles::add(std::int64_t id, const Vector& at, double m, double v, double h, double c,
                    Origin from) {
  identity.push_back(id);
  position.push_back(at);
  velocity.push_back({});
  mass.push_back(m);
  volume.push_back(v);
  density.push_back(m / v);
  enthalpy.push_back(h);
  concentration.push_back(c);
  temperature.push_back(0);
  liquid_fraction.push_back(0);
  peak_temperature.push_back(0);
  melt_time.push_back(-1);
  freeze_time.push_back(-1);
  cooling_rate.push_back(0);
  freeze_gradient.push_back(0);
  origin.push_back(from);
  phase.push_back(Phase::solid);
  melted.push_back(0);
  order.push_back(order.size());
  home.push_back(Home::here);
}

Vector lower_corner(const Particles& particles) {
  Vector lower;
  lower.fill(std::numeric_limits<double>::infinity());
  for (const auto& at : particles.position) {
    for (std::size_t d = 0; d < 3; ++d) {
      lower[d] = std::min(lower[d], at[d]);
    }
  }
  return lower;
}

void sort_in_space(Particles& particles, double cell_size) {
  sort_in_space(particles, cell_size, lower_corner(particles));
}

std::uint64_t place_in_space(const Vector& at, const Vector& lower, double cell_size) {
  std::array<std::uint64_t, 3> cell{};
  for (std::size_t d = 0; d < 3; ++d) {
    cell[d] = static_cast<std::uint64_t>((at[d] - lower[d]) / cell_size);
  }
  return spread(cell[0]) | spread(cell[1]) << 1U | spread(cell[2]) << 2U;
}

void sort_in_space(Particles& particles, double cell_size, const Vector& lower) {
  for (std::size_t i = 0; i < particles.size(); ++i) {
    particles.order[i] = place_in_space(particles.position[i], lower, cell_size);
  }
  std::vector<std::uint32_t> sorted(particles.size());
  std::iota(sorted.begin(), sorted.end(), 0U);
  std::sort(sorted.begin(), sorted.end(),
            [&](std::uint32_t a, std::uint32_t b) { return particles.before(a, b); });
  particles.each_array([&](auto& values) { permute(values, sorted); });
}

}  // namespace meltproof::solver

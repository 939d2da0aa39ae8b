// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/metal_grid.hpp"

#include <array>

namespace meltproof::solver {

MetalGrid::MetalGrid(const Particles& particles, const Vector& lower, const Vector& upper)
    : particles_(particles),
      cell_(particles.spacing),
      lower_(everywhere(1)),
      upper_(everywhere(-1)),
      held_(particles.size(), 0) {
  for (std::uint32_t i = 0; i < particles.size(); ++i) {
    const Vector& at = particles.position[i];
    bool inside = particles.phase[i] == Phase::solid || particles.phase[i] == Phase::liquid;
    for (std::size_t d = 0; d < 3; ++d) {
      inside = inside && std::isfinite(at[d]) && at[d] >= lower[d] && at[d] <= upper[d];
    }
    if (inside) {
      held_[i] = 1;
      by_identity_.push_back(i);
      for (std::size_t d = 0; d < 3; ++d) {
        lower_[d] = std::min(lower_[d], at[d]);
        upper_[d] = std::max(upper_[d], at[d]);
      }
    }
  }
  if (by_identity_.empty()) {
    lower_ = upper_ = Vector{};
    return;
  }
  std::sort(by_identity_.begin(), by_identity_.end(), [&](std::uint32_t a, std::uint32_t b) {
    return particles.identity[a] < particles.identity[b];
  });
  std::size_t cells = 1;
  for (std::size_t d = 0; d < 3; ++d) {
    // Half a cell of margin, so that round-off at the faces of a lattice does not matter.
    lower_[d] -= 0.5 * cell_;
    upper_[d] += 0.5 * cell_;
    count_[d] = static_cast<std::size_t>((upper_[d] - lower_[d]) / cell_) + 1;
    cells *= count_[d];
  }
  const auto flat = [&](std::uint32_t i) {
    const auto c = cell_of(particles.position[i]);
    return (c[2] * count_[1] + c[1]) * count_[0] + c[0];
  };
  first_.assign(cells + 1, 0);
  for (const std::uint32_t i : by_identity_) {
    ++first_[flat(i) + 1];
  }
  for (std::size_t c = 0; c < cells; ++c) {
    first_[c + 1] += first_[c];
  }
  index_.resize(by_identity_.size());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (const std::uint32_t i : by_identity_) {
    index_[next[flat(i)]++] = i;
  }
}

std::array<std::size_t, 3> MetalGrid::cell_of(const Vector& at) const {
  std::array<std::size_t, 3> c{};
  for (std::size_t d = 0; d < 3; ++d) {
    c[d] = static_cast<std::size_t>(std::max(0.0, (at[d] - lower_[d]) / cell_));
    c[d] = std::min(c[d], count_[d] - 1);
  }
  return c;
}

double nearest_distance(const MetalGrid& grid, const Particles& particles, std::size_t i,
                        double reach) {
  // Most neighbours are within a spacing and a half: the wide search is for the few that are alone.
  for (const double near : {std::min(reach, 1.5 * particles.spacing), reach}) {
    double nearest = near * near;
    bool found = false;
    grid.for_each_within(particles.position[i], near, [&](std::uint32_t j, double r2) {
      if (j != i && r2 <= nearest) {
        nearest = r2;
        found = true;
      }
    });
    if (found) {
      return std::sqrt(nearest);
    }
  }
  return reach;
}

}  // namespace meltproof::solver

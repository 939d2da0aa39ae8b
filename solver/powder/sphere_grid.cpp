// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/powder/sphere_grid.hpp"

#include <algorithm>
#include <cmath>

namespace meltproof::solver {

SphereGrid::SphereGrid(double length_x, double length_y, double largest_diameter, bool periodic)
    : length_x_(length_x), length_y_(length_y), cell_(largest_diameter), periodic_(periodic) {
  count_x_ = std::max(1, static_cast<int>(length_x / largest_diameter));
  count_y_ = std::max(1, static_cast<int>(length_y / largest_diameter));
  cell_x_ = length_x / count_x_;
  cell_y_ = length_y / count_y_;
}

void SphereGrid::add(const Sphere& sphere) {
  Sphere inside = sphere;
  if (periodic_) {
    inside.centre.x() -= length_x_ * std::floor(inside.centre.x() / length_x_);
    inside.centre.y() -= length_y_ * std::floor(inside.centre.y() / length_y_);
  }
  // Rounding can put a centre onto the far side of the box itself.
  const int x = std::min(count_x_ - 1, static_cast<int>(inside.centre.x() / cell_x_));
  const int y = std::min(count_y_ - 1, static_cast<int>(inside.centre.y() / cell_y_));
  const int z = cell_of(inside.centre.z());
  if (z >= layers_) {
    layers_ = z + 1;
    cells_.resize(static_cast<std::size_t>(layers_) * count_x_ * count_y_);
  }
  cells_[cell_index(x, y, z)].push_back(static_cast<int>(spheres_.size()));
  spheres_.push_back(inside);
}

}  // namespace meltproof::solver

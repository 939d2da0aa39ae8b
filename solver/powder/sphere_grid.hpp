// SPDX-License-Identifier: GPL-3.0-or-later
// Spheres at rest in a box, found again by place.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

namespace meltproof::solver {

/// A sphere at rest.
struct Sphere {
  Eigen::Vector3d centre{0, 0, 0};  ///< m
  double radius = 0;                ///< m
};

/// The spheres of a box on the floor z = 0, sorted into cells as wide as the largest of them. In a
/// periodic box each sphere stands for its images as well.
class SphereGrid {
 public:
  /// @param length_x, length_y the box, m; @param largest_diameter of the spheres to come, m.
  SphereGrid(double length_x, double length_y, double largest_diameter, bool periodic);

  void add(const Sphere& sphere);
  const std::vector<Sphere>& spheres() const { return spheres_; }
  double length_x() const { return length_x_; }
  double length_y() const { return length_y_; }
  bool periodic() const { return periodic_; }

  /// A sphere near a place, with the image that is meant.
  struct Near {
    int index = 0;
    Eigen::Vector3d centre{0, 0, 0};  ///< of the image, m
    double radius = 0;                ///< m
  };
  /// Calls `visit(near)` for every image whose centre may lie within `reach` of `place` (some lie
  /// farther). The place may lie outside a periodic box.
  template <class Visit>
  void visit_near(const Eigen::Vector3d& place, double reach, Visit visit) const {
    visit_cells(place, reach, cell_of(place.z() - reach), cell_of(place.z() + reach), visit);
  }
  /// The same for every image whose axis passes within `reach` of the vertical through `place`,
  /// layer by layer from the highest down, until `visit_layer_done(z)` returns true, where all
  /// spheres yet to come have their centres below z.
  template <class Visit, class Done>
  void visit_column(const Eigen::Vector3d& place, double reach, Visit visit, Done done) const {
    for (int layer = layers_ - 1; layer >= 0; --layer) {
      if (done((layer + 1) * cell_)) {
        return;
      }
      visit_cells(place, reach, layer, layer, visit);
    }
  }

 private:
  int cell_of(double length) const { return static_cast<int>(std::floor(length / cell_)); }
  template <class Visit>
  void visit_cells(const Eigen::Vector3d& place, double reach, int low, int high,
                   Visit& visit) const {
    const int first_x = static_cast<int>(std::floor((place.x() - reach) / cell_x_));
    const int last_x = static_cast<int>(std::floor((place.x() + reach) / cell_x_));
    const int first_y = static_cast<int>(std::floor((place.y() - reach) / cell_y_));
    const int last_y = static_cast<int>(std::floor((place.y() + reach) / cell_y_));
    for (int z = std::max(low, 0); z <= std::min(high, layers_ - 1); ++z) {
      for (int y = first_y; y <= last_y; ++y) {
        for (int x = first_x; x <= last_x; ++x) {
          // Whole boxes that this cell lies away from the first one.
          const int box_x = floor_division(x, count_x_), box_y = floor_division(y, count_y_);
          if (!periodic_ && (box_x != 0 || box_y != 0)) {
            continue;
          }
          const Eigen::Vector3d shift(box_x * length_x_, box_y * length_y_, 0);
          for (const int i : cells_[cell_index(x - box_x * count_x_, y - box_y * count_y_, z)]) {
            visit(Near{i, spheres_[i].centre + shift, spheres_[i].radius});
          }
        }
      }
    }
  }
  static int floor_division(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }
  std::size_t cell_index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * count_y_ + y) * count_x_ + x;
  }

  double length_x_, length_y_, cell_, cell_x_, cell_y_;
  bool periodic_;
  int count_x_, count_y_, layers_ = 0;
  std::vector<Sphere> spheres_;
  std::vector<std::vector<int>> cells_;
};

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/powder/drop_and_roll.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "solver/powder/arc.hpp"
#include "solver/powder/descent.hpp"

namespace meltproof::solver {
namespace {

using Eigen::Vector3d;

constexpr int most_events = 500;
/// A contact that would be entered within this angle while it is being left is still a contact.
constexpr double smallest_angle = 1e-7;

/// Something that the moving sphere touches: a sphere, or the plane with normal `direction`.
struct Contact {
  int support = no_support;
  Vector3d point{0, 0, 0};      ///< centre of the sphere, or a point of the plane
  double distance = 0;          ///< of the moving centre from the point or plane
  Vector3d direction{0, 0, 1};  ///< unit vector to the moving centre
  bool plane() const { return support < 0; }
};

class Roll {
 public:
  Roll(const SphereGrid& grid, double largest_radius, double radius, double x, double y)
      : grid_(grid), largest_(largest_radius), radius_(radius), place_(x, y, 0) {
    planes_.push_back({floor_support, Vector3d::Zero(), radius, Vector3d::UnitZ()});
    if (!grid.periodic()) {
      const Vector3d far(grid.length_x(), grid.length_y(), 0);
      planes_.push_back({wall_support, Vector3d::Zero(), radius, Vector3d::UnitX()});
      planes_.push_back({wall_support, Vector3d::Zero(), radius, Vector3d::UnitY()});
      planes_.push_back({wall_support, far, radius, -Vector3d::UnitX()});
      planes_.push_back({wall_support, far, radius, -Vector3d::UnitY()});
    }
  }

  std::optional<Settled> follow() {
    place_.z() = std::numeric_limits<double>::infinity();
    fall();
    for (int event = 0; event < most_events; ++event) {
      find_contacts();
      std::vector<Vector3d> directions;
      for (const Contact& contact : contacts_) {
        directions.push_back(contact.direction);
      }
      const Descent descent = steepest_descent(directions);
      if (descent.rests) {
        return settled(descent);
      }
      if (descent.count == 0) {
        fall();
      } else if (!roll(descent)) {
        return std::nullopt;
      }
    }
    return std::nullopt;
  }

 private:
  void find_contacts() {
    contacts_.clear();
    for (Contact plane : planes_) {
      plane.distance = plane.direction.dot(place_ - plane.point);
      if (plane.distance - radius_ < contact_tolerance * radius_) {
        contacts_.push_back(plane);
      }
    }
    grid_.visit_near(place_, radius_ + largest_, [this](const SphereGrid::Near& near) {
      const Vector3d from = place_ - near.centre;
      const double distance = from.norm();
      if (distance - radius_ - near.radius < contact_tolerance * radius_) {
        contacts_.push_back({near.index, near.centre, radius_ + near.radius, from / distance});
      }
    });
  }

  bool touches(const SphereGrid::Near& near) const {
    return std::any_of(contacts_.begin(), contacts_.end(), [&near](const Contact& contact) {
      return contact.support == near.index &&
             (contact.point - near.centre).squaredNorm() < 1e-6 * near.radius * near.radius;
    });
  }

  /// Straight down to the first sphere or the floor. Spheres that are touched now are being left at
  /// or below their widest place and cannot be met again.
  void fall() {
    double height = radius_;
    grid_.visit_column(
        place_, radius_ + largest_,
        [&](const SphereGrid::Near& near) {
          const double contact = radius_ + near.radius;
          const double aside = (near.centre - place_).head<2>().squaredNorm();
          if (aside < contact * contact) {
            const double above = near.centre.z() + std::sqrt(contact * contact - aside);
            if (above > height && above < place_.z() && !touches(near)) {
              height = above;
            }
          }
        },
        [&](double z) { return z + radius_ + largest_ < height; });
    place_.z() = height;
  }

  /// Over the carrying contacts to the next event. False if there is none: an edge of balance.
  bool roll(const Descent& descent) {
    std::vector<int> carrying(descent.carrying.begin(), descent.carrying.begin() + descent.count);
    Arc arc;
    for (;;) {
      if (!make_arc(carrying, descent.direction, arc)) {
        return false;
      }
      const int held = held_by_curvature(arc, carrying);
      if (held < 0) {
        break;
      }
      carrying.push_back(held);
      if (carrying.size() > 2) {
        return false;
      }
    }
    double angle = release_angle(arc, carrying);
    for (const Contact& plane : planes_) {
      const auto now = std::find_if(contacts_.begin(), contacts_.end(), [&plane](const Contact& c) {
        return c.plane() && c.direction == plane.direction;
      });
      if (now == contacts_.end()) {
        angle =
            std::min(angle, arc.distance_to_plane(plane.direction, plane.point, radius_).falls());
      }
    }
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (std::find(carrying.begin(), carrying.end(), static_cast<int>(i)) == carrying.end()) {
        angle = std::min(angle, distance_wave(arc, contacts_[i]).falls_again());
      }
    }
    grid_.visit_near(
        arc.centre, arc.radius + radius_ + largest_, [&](const SphereGrid::Near& near) {
          const double contact = radius_ + near.radius;
          if ((near.centre - arc.centre).norm() < arc.radius + contact && !touches(near)) {
            angle = std::min(angle, arc.distance_to(near.centre, contact).falls());
          }
        });
    if (!std::isfinite(angle)) {
      return false;
    }
    place_ = arc.at(angle);
    return true;
  }

  static Wave distance_wave(const Arc& arc, const Contact& c) {
    return c.plane() ? arc.distance_to_plane(c.direction, c.point, c.distance)
                     : arc.distance_to(c.point, c.distance);
  }

  /// The circle on which the centre moves while it keeps the carrying contacts.
  bool make_arc(const std::vector<int>& carrying, const Vector3d& downhill, Arc& arc) const {
    const Contact* first = &contacts_[carrying[0]];
    if (carrying.size() == 1) {
      if (first->plane()) {
        return false;
      }
      arc.centre = first->point;
      arc.radius = (place_ - first->point).norm();
      arc.u = first->direction;
      const Vector3d tangent = downhill - downhill.dot(arc.u) * arc.u;
      arc.t = tangent.normalized();
      return tangent.norm() > 1e-9;
    }
    const Contact* second = &contacts_[carrying[1]];
    if (first->plane()) {
      std::swap(first, second);
    }
    if (first->plane()) {
      return false;
    }
    const Vector3d axis =
        second->plane() ? second->direction : (second->point - first->point).normalized();
    arc.centre = first->point + axis * axis.dot(place_ - first->point);
    const Vector3d outward = place_ - arc.centre;
    arc.radius = outward.norm();
    if (arc.radius < 1e-9 * radius_) {
      return false;
    }
    arc.u = outward / arc.radius;
    arc.t = axis.cross(arc.u);
    if (arc.t.z() > 0) {
      arc.t = -arc.t;
    }
    return arc.t.z() < -1e-9;
  }

  /// A contact without force into which the arc curves at once carries as well; -1 if there is
  /// none.
  int held_by_curvature(const Arc& arc, const std::vector<int>& carrying) const {
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (std::find(carrying.begin(), carrying.end(), static_cast<int>(i)) == carrying.end() &&
          distance_wave(arc, contacts_[i]).falls_again() < smallest_angle) {
        return static_cast<int>(i);
      }
    }
    return -1;
  }

  /// Where a contact force vanishes. One contact: at the widest place of the sphere below. Two,
  /// with unit vectors e_j, e_k and tangent t: N_k = z . (t x e_j) / (e_k . (t x e_j)), whose
  /// denominator is constant along the circle.
  double release_angle(const Arc& arc, const std::vector<int>& carrying) const {
    if (carrying.size() == 1) {
      return Wave{arc.u.z(), arc.t.z(), 0}.falls();
    }
    const Vector3d m = arc.u.cross(arc.t);
    double angle = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 2; ++k) {
      const Contact &kept = contacts_[carrying[1 - k]], &released = contacts_[carrying[k]];
      const double along = kept.plane() ? kept.direction.dot(m) : (arc.centre - kept.point).dot(m);
      const double across = kept.plane() ? 0 : -arc.radius * m.z();
      const double sign = released.direction.dot(arc.t.cross(kept.direction)) < 0 ? -1 : 1;
      const Wave force{sign * along * arc.u.z(), sign * along * arc.t.z(), -sign * across};
      const double now = force.a - force.c;
      const double scale = std::abs(force.a) + std::abs(force.b) + std::abs(force.c);
      angle = std::min(angle, now > 1e-9 * scale ? force.falls() : force.falls_again());
    }
    return angle;
  }

  std::optional<Settled> settled(const Descent& descent) const {
    Settled result{{place_, radius_}, {no_support, no_support, no_support}};
    bool floor = false;
    for (int i = 0; i < descent.count; ++i) {
      result.supports[i] = contacts_[descent.carrying[i]].support;
      floor = floor || result.supports[i] == floor_support;
    }
    if (!floor && descent.count < 3) {
      return std::nullopt;
    }
    bool clear = true;
    grid_.visit_near(place_, radius_ + largest_, [&](const SphereGrid::Near& near) {
      const double gap = (place_ - near.centre).norm() - radius_ - near.radius;
      clear = clear && gap > -1e-9 * std::min(radius_, near.radius);
    });
    return clear ? std::optional(result) : std::nullopt;
  }

  const SphereGrid& grid_;
  double largest_, radius_;
  Vector3d place_;
  std::vector<Contact> planes_, contacts_;
};

}  // namespace

std::optional<Settled> drop_and_roll(const SphereGrid& grid, double largest_radius, double radius,
                                     double x, double y) {
  return Roll(grid, largest_radius, radius, x, y).follow();
}

}  // namespace meltproof::solver

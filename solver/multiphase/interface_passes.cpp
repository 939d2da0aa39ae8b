// SPDX-License-Identifier: GPL-3.0-or-later
// The passes over the interface: colour gradient, curvature, and the force of the surface.
#include <cmath>

#include <Eigen/Dense>

#include "solver/multiphase/pass.hpp"

namespace meltproof::solver {
namespace {

template <int D>
using Matrix = Eigen::Matrix<double, D, D>;

template <int D>
Matrix<D> full(const std::array<Components<D, Lane>, D>& sums) {
  Matrix<D> result;
  for (std::size_t a = 0; a < D; ++a) {
    for (std::size_t b = 0; b < D; ++b) {
      result(static_cast<int>(a), static_cast<int>(b)) = sum_lanes(sums[a][b]);
    }
  }
  return result;
}

/// The same from its upper half.
template <int D>
Matrix<D> symmetric(const std::array<Components<D, Lane>, D>& sums) {
  const Matrix<D> upper = full<D>(sums);
  return Matrix<D>(upper.template selfadjointView<Eigen::Upper>());
}

/// The inverse of a second moment; zero where neighbours do not span space.
template <int D>
Matrix<D> inverse(const Matrix<D>& moment) {
  // On the undisturbed lattice the moment is the unit matrix.
  constexpr double flat = 1e-3;
  return moment.determinant() > flat ? Matrix<D>(moment.inverse()) : Matrix<D>(Matrix<D>::Zero());
}

/// Below this length times h a colour gradient is too weak to give a direction. (Morris 2000)
constexpr double weakest_normal = 0.01;

}  // namespace

template <int D>
void ClosedFlow::sum_interface() {
  const std::size_t n = particles_.size();
  for_each_particle(n, [&](std::size_t i) {
    InterfaceRecord& record = surface_[i];
    set(record, InterfaceRecord::position(), particles_.position[i]);
    record.volume = is_fluid(i) ? records_[i].volume : 0;
    record.density = records_[i].density;
    record.side = particles_.phase[i] == Phase::gas ? 1 : 0;
    record.tension = fields_.tension[i];
  });
  fill_images(surface_, [](InterfaceRecord&, const Ghost&) {});
  const InterfaceRecord* all = surface_.data();
  // surface_force_ holds the colour gradient until the force is known.
  for_each_particle(n, [&](std::size_t i) {
    const InterfaceRecord& own = all[i];
    const Lane volume = own.volume, density = own.density, side = own.side;
    Components<D, Lane> sum{};
    Lane share = 0;
    if (is_fluid(i)) {
      for_each_group<D>(
          neighbours_, i, all, [&](const PairGeometry<D, Lane>& pair, const std::uint32_t* j) {
            const Lane volume_j = gather(all, j, &InterfaceRecord::volume),
                       side_j = gather(all, j, &InterfaceRecord::side);
            const Lane factor = colour_pair<Lane>(volume, density, side, volume_j,
                                                  gather(all, j, &InterfaceRecord::density), side_j,
                                                  pair.gradient(kernel_));
            share += across(side, side_j) * volume_j * kernel_.value(pair.distance);
            for (std::size_t d = 0; d < D; ++d) {
              sum[d] += factor * pair.r[d];
            }
          });
    }
    interface_depth_[i] = depth_(sum_lanes(share));
    double squared = 0;
    surface_force_[i] = {};
    for (std::size_t d = 0; d < D; ++d) {
      surface_force_[i][d] = own.volume > 0 ? sum_lanes(sum[d]) / own.volume : 0;
      squared += surface_force_[i][d] * surface_force_[i][d];
    }
    const double length = std::sqrt(squared);
    const bool known = length * kernel_.smoothing_length > weakest_normal;
    for (std::size_t d = 0; d < 3; ++d) {
      normal_[i][d] = known ? surface_force_[i][d] / length : 0;
    }
  });
  for_each_particle(n, [&](std::size_t i) {
    set(surface_[i], InterfaceRecord::normal(), normal_[i]);
    surface_[i].near = dot<3>(normal_[i], normal_[i]) > 0 ? 1 : 0;
  });
  fill_images(surface_, [](InterfaceRecord& image, const Ghost& ghost) {
    set(image, InterfaceRecord::normal(), ghost.mirrored(get(image, InterfaceRecord::normal())));
  });
  for_each_particle(n, [&](std::size_t i) {
    const InterfaceRecord& own = all[i];
    curvature_[i] = 0;
    if (own.near == 0) {
      surface_force_[i] = {};
      return;
    }
    const auto normal_i = spread<D>(own, InterfaceRecord::normal());
    const Lane side = own.side, tension = own.tension;
    CurvatureSums<D, Lane> sums;
    GradientSums<D, Lane> slope;
    for_each_group<D>(
        neighbours_, i, all, [&](const PairGeometry<D, Lane>& pair, const std::uint32_t* j) {
          const Lane gradient = pair.gradient(kernel_),
                     volume = gather(all, j, &InterfaceRecord::volume);
          curvature_pair<D, Lane>(sums, pair, normal_i, side,
                                  gather<D>(all, j, InterfaceRecord::normal()),
                                  gather(all, j, &InterfaceRecord::side),
                                  gather(all, j, &InterfaceRecord::near), volume, gradient);
          gradient_pair<D, Lane>(slope, pair, gather(all, j, &InterfaceRecord::tension) - tension,
                                 volume, gradient);
        });
    const Matrix<D> change = full<D>(sums.change);
    curvature_[i] = curvature_at_interface(
        change.cwiseProduct(inverse<D>(symmetric<D>(sums.moment))).sum(), interface_depth_[i], D);
    Eigen::Matrix<double, D, 1> gradient, normal;
    for (int a = 0; a < D; ++a) {
      const auto d = static_cast<std::size_t>(a);
      gradient(a) = sum_lanes(slope.gradient[d]);
      normal(a) = normal_[i][d];
    }
    const Eigen::Matrix<double, D, 1> tension_slope =
        inverse<D>(symmetric<D>(slope.moment)) * gradient;
    const Eigen::Matrix<double, D, 1> tangential =
        tension_slope - normal * normal.dot(tension_slope);
    const double delta = std::sqrt(dot<3>(surface_force_[i], surface_force_[i]));
    // Pressure, and so the pull of the surface, acts against the outward normal of either side.
    const double inward = own.tension * curvature_[i] + fields_.recoil[i];
    for (std::size_t d = 0; d < D; ++d) {
      surface_force_[i][d] =
          own.volume * delta * (tangential(static_cast<int>(d)) - inward * normal_[i][d]);
    }
  });
}

template void ClosedFlow::sum_interface<2>();
template void ClosedFlow::sum_interface<3>();

}  // namespace meltproof::solver

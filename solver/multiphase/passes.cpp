// SPDX-License-Identifier: GPL-3.0-or-later
// The passes of one evaluation, in the order in which they need each other.
#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "solver/multiphase/closed_flow.hpp"
#include "solver/particles/block_sum.hpp"
#include "solver/terms/conduction.hpp"

namespace meltproof::solver {
namespace {

/// Calls body(pair, indices of its j) for every group of lanes in the list of i.
template <int D, class Record, class Body>
void for_each_group(const NeighbourList& list, std::size_t i, const Record* all, const Body& body) {
  const auto own = spread<D>(all[i], Record::position());
  for (std::size_t k = list.first[i]; k < list.last[i]; k += lane_count) {
    const std::uint32_t* j = &list.index[k];
    body(PairGeometry<D, Lane>(own, gather<D>(all, j, Record::position())), j);
  }
}

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

template <class Record, class Change>
void ClosedFlow::fill_images(std::vector<Record>& records, const Change& change) const {
  const std::size_t n = particles_.size();
  for_each_particle(ghosts_.size(), [&](std::size_t g) {
    const Ghost& ghost = ghosts_[g];
    Record& image = records[n + g];
    image = records[ghost.source];
    set(image, Record::position(), ghost.image_of(particles_.position[ghost.source]));
    change(image, ghost);
  });
}

template <int D>
void ClosedFlow::sum_density() {
  const std::size_t n = particles_.size();
  for_each_particle(n, [&](std::size_t i) {
    set(records_[i], FlowRecord::position(), particles_.position[i]);
    records_[i].fluid = is_fluid(i) ? 1 : 0;
  });
  fill_images(records_, [](FlowRecord&, const Ghost&) {});
  const double own = kernel_.value(0.0);
  for_each_particle(n, [&](std::size_t i) {
    FlowRecord& record = records_[i];
    if (!is_fluid(i)) {
      record.volume = particles_.volume[i];
      return;
    }
    Lane sum = 0;
    for_each_group<D>(neighbours_, i, records_.data(),
                      [&](const PairGeometry<D, Lane>& pair, const std::uint32_t*) {
                        sum += kernel_.value(pair.distance);
                      });
    const Fluid& fluid = model_.fluids[static_cast<std::size_t>(fields_.fluid[i])];
    record.volume = 1 / (own + sum_lanes(sum));
    record.density = particles_.mass[i] / record.volume;
    record.pressure =
        state_pressure(record.density, fluid.density, model_.stiffness, model_.added_pressure);
    record.viscosity = fields_.viscosity[i];
    set(record, FlowRecord::velocity(), particles_.velocity[i]);
    set(record, FlowRecord::transport(), transport_[i]);
    particles_.density[i] = record.density;
    pressure_[i] = record.pressure;
  });
}

template <int D>
void ClosedFlow::extrapolate_to_walls() {
  const FlowRecord* all = records_.data();
  for_each_particle(particles_.size(), [&](std::size_t i) {
    if (is_fluid(i)) {
      return;
    }
    WallSums<Lane> sums;
    Lane density_sum = 0, viscosity_sum = 0;
    for_each_group<D>(
        neighbours_, i, all, [&](const PairGeometry<D, Lane>& pair, const std::uint32_t* j) {
          const Lane w = kernel_.value(pair.distance) * gather(all, j, &FlowRecord::fluid);
          const Lane density = gather(all, j, &FlowRecord::density);
          const auto v = gather<D>(all, j, FlowRecord::velocity());
          Components<3, Lane> velocity{}, r{};
          for (std::size_t d = 0; d < D; ++d) {
            velocity[d] = v[d];
            r[d] = pair.r[d];
          }
          wall_pair(sums, w, r[0], r[1], r[2], gather(all, j, &FlowRecord::pressure), density,
                    velocity[0], velocity[1], velocity[2]);
          density_sum += w * density;
          viscosity_sum += w * gather(all, j, &FlowRecord::viscosity);
        });
    const WallSums<double> total{sum_lanes(sums.weight),     sum_lanes(sums.pressure),
                                 sum_lanes(sums.moment_x),   sum_lanes(sums.moment_y),
                                 sum_lanes(sums.moment_z),   sum_lanes(sums.velocity_x),
                                 sum_lanes(sums.velocity_y), sum_lanes(sums.velocity_z)};
    FlowRecord& record = records_[i];
    const Vector& g = model_.gravity;
    const Vector& a = fields_.wall_acceleration[i];
    const Vector& v = particles_.velocity[i];
    record.pressure = wall_pressure(total, g[0] - a[0], g[1] - a[1], g[2] - a[2]);
    // A wall shows each fluid what that fluid has itself: mean density and viscosity of those near.
    record.density = total.weight > 0 ? sum_lanes(density_sum) / total.weight : 1;
    // And is as compressed as the fluid at its pressure, or layers near a wall could not be at
    // rest.
    const double compression = 1 + (record.pressure - model_.added_pressure) / model_.stiffness;
    record.volume = particles_.volume[i] / std::max(0.5, compression);
    record.viscosity = total.weight > 0 ? sum_lanes(viscosity_sum) / total.weight : 0;
    record.vx = wall_velocity(v[0], total.velocity_x, total.weight);
    record.vy = wall_velocity(v[1], total.velocity_y, total.weight);
    record.vz = D == 3 ? wall_velocity(v[2], total.velocity_z, total.weight) : 0;
    pressure_[i] = record.pressure;
  });
}

template <int D>
void ClosedFlow::sum_forces() {
  const FlowRecord* all = records_.data();
  for_each_particle(particles_.size(), [&](std::size_t i) {
    if (!is_fluid(i)) {
      return;
    }
    const FlowRecord& own = all[i];
    const MomentumState<D, Lane> state_i{spread<D>(own, FlowRecord::velocity()),
                                         spread<D>(own, FlowRecord::transport()),
                                         own.volume,
                                         own.density,
                                         own.pressure,
                                         own.viscosity};
    MomentumSums<D, Lane> sums;
    for_each_group<D>(
        neighbours_, i, all, [&](const PairGeometry<D, Lane>& pair, const std::uint32_t* j) {
          const MomentumState<D, Lane> state_j{
              gather<D>(all, j, FlowRecord::velocity()), gather<D>(all, j, FlowRecord::transport()),
              gather(all, j, &FlowRecord::volume),       gather(all, j, &FlowRecord::density),
              gather(all, j, &FlowRecord::pressure),     gather(all, j, &FlowRecord::viscosity)};
          momentum_pair<D, Lane>(sums, pair, kernel_, state_i, state_j);
        });
    const double per_mass = 1 / particles_.mass[i];
    for (std::size_t d = 0; d < D; ++d) {
      acceleration_[i][d] =
          per_mass * (sum_lanes(sums.force[d]) + surface_force_[i][d]) + model_.gravity[d];
      background_[i][d] = -model_.background * per_mass * sum_lanes(sums.background[d]);
    }
  });
}

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

template <int D>
void ClosedFlow::conduct_heat() {
  const std::size_t n = particles_.size();
  const auto fluid_of = [&](std::size_t i) -> const Fluid& {
    return model_.fluids[static_cast<std::size_t>(std::max(0, fields_.fluid[i]))];
  };
  for_each_particle(n, [&](std::size_t i) {
    heat_[i].temperature = particles_.temperature[i];
    heat_[i].conductivity = fluid_of(i).conductivity;
  });
  for_each_particle(ghosts_.size(), [&](std::size_t g) {
    const Ghost& ghost = ghosts_[g];
    heat_[n + g] = heat_[ghost.source];
    heat_[n + g].temperature = ghost.sign * heat_[ghost.source].temperature + ghost.offset;
  });
  const FlowRecord* all = records_.data();
  const ConductionRecord* heat = heat_.data();
  for_each_particle(n, [&](std::size_t i) {
    const Lane conductivity = heat[i].conductivity, temperature = heat[i].temperature;
    Lane sum = 0;
    if (is_fluid(i)) {
      for_each_group<D>(
          neighbours_, i, all, [&](const PairGeometry<D, Lane>& pair, const std::uint32_t* j) {
            sum += conduction_pair<Lane>(
                conductivity, temperature, gather(heat, j, &ConductionRecord::conductivity),
                gather(heat, j, &ConductionRecord::temperature),
                gather(all, j, &FlowRecord::volume), kernel_.gradient_factor(pair.squared));
          });
    }
    heating_[i] = sum_lanes(sum) / (records_[i].density * fluid_of(i).specific_heat);
  });
}

template <int D>
void ClosedFlow::evaluate_in() {
  sum_density<D>();
  extrapolate_to_walls<D>();
  fill_images(records_, [](FlowRecord& image, const Ghost& ghost) {
    set(image, FlowRecord::velocity(), ghost.mirrored(get(image, FlowRecord::velocity())));
    set(image, FlowRecord::transport(), ghost.mirrored(get(image, FlowRecord::transport())));
  });
  if (model_.interface) {
    sum_interface<D>();
  }
  sum_forces<D>();
  if (model_.heat) {
    conduct_heat<D>();
  }
}

void ClosedFlow::evaluate() {
  if (particles_.dimensions == 2) {
    evaluate_in<2>();
  } else {
    evaluate_in<3>();
  }
}

}  // namespace meltproof::solver

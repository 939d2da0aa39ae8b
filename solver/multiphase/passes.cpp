// SPDX-License-Identifier: GPL-3.0-or-later
// The passes of one evaluation, in the order in which they need each other; those over the
// interface are in interface_passes.cpp.
#include <algorithm>
#include <cmath>

#include "solver/multiphase/pass.hpp"
#include "solver/terms/conduction.hpp"
#include "solver/terms/continuity.hpp"

namespace meltproof::solver {

template <int D>
void ClosedFlow::sum_density() {
  const std::size_t n = particles_.size();
  for_each_particle(
      n, [&](std::size_t i) { set(records_[i], FlowRecord::position(), particles_.position[i]); });
  fill_images(records_, [](FlowRecord&, const Ghost&) {});
  const double own = kernel_.value(0.0);
  for_each_particle(n, [&](std::size_t i) {
    if (!is_fluid(i)) {
      return;
    }
    Lane sum = 0;
    for_each_group<D>(neighbours_, i, records_.data(),
                      [&](const PairGeometry<D, Lane>& pair, const std::uint32_t*) {
                        sum += kernel_.value(pair.distance);
                      });
    particles_.density[i] = particles_.mass[i] * (own + sum_lanes(sum));
  });
}

template <int D>
void ClosedFlow::continue_density(double dt) {
  const std::size_t n = particles_.size();
  for_each_particle(n, [&](std::size_t i) {
    FlowRecord& record = records_[i];
    set(record, FlowRecord::position(), particles_.position[i]);
    set(record, FlowRecord::velocity(), particles_.velocity[i]);
    record.fluid = is_fluid(i) ? 1 : 0;
    record.volume = is_fluid(i) ? particles_.mass[i] / particles_.density[i] : particles_.volume[i];
    record.pressure = pressure_[i];
  });
  fill_images(records_, [](FlowRecord& image, const Ghost& ghost) {
    set(image, FlowRecord::velocity(), ghost.mirrored(get(image, FlowRecord::velocity())));
  });
  const FlowRecord* all = records_.data();
  const double at_centre = kernel_.value(0.0), h = kernel_.smoothing_length;
  for_each_particle(n, [&](std::size_t i) {
    if (!is_fluid(i)) {
      return;
    }
    const FlowRecord& own = all[i];
    const auto velocity = spread<D>(own, FlowRecord::velocity());
    Lane compression = 0, diffused = 0, number = 0;
    for_each_group<D>(
        neighbours_, i, all, [&](const PairGeometry<D, Lane>& pair, const std::uint32_t* j) {
          const Lane volume = gather(all, j, &FlowRecord::volume);
          auto approach = gather<D>(all, j, FlowRecord::velocity());
          for (std::size_t d = 0; d < D; ++d) {
            approach[d] = velocity[d] - approach[d];
          }
          compression +=
              continuity_pair<Lane>(volume, pair.gradient(kernel_), dot<D>(approach, pair.r));
          // Of the pressures, which are equal where two fluids meet; densities are not.
          diffused += gather(all, j, &FlowRecord::fluid) *
                      density_diffusion_pair<Lane>(own.pressure,
                                                   gather(all, j, &FlowRecord::pressure), Lane(0.0),
                                                   volume, kernel_.gradient_factor(pair.squared));
          number += kernel_.value(pair.distance);
        });
    const double reference = model_.fluids[static_cast<std::size_t>(fields_.fluid[i])].density;
    const double sound = std::sqrt(model_.stiffness / reference);
    double& density = particles_.density[i];
    const double summed = particles_.mass[i] * (at_centre + sum_lanes(number));
    density += dt * (density * sum_lanes(compression) +
                     model_.density_diffusion * h * sound * reference / model_.stiffness *
                         sum_lanes(diffused) +
                     sound / (model_.density_relaxation * h) * (summed - density));
  });
}

void ClosedFlow::fill_records() {
  for_each_particle(particles_.size(), [&](std::size_t i) {
    FlowRecord& record = records_[i];
    record.fluid = is_fluid(i) ? 1 : 0;
    if (!is_fluid(i)) {
      record.volume = particles_.volume[i];
      return;
    }
    const Fluid& fluid = model_.fluids[static_cast<std::size_t>(fields_.fluid[i])];
    record.density = particles_.density[i];
    record.volume = particles_.mass[i] / record.density;
    record.pressure =
        state_pressure(record.density, fluid.density, model_.stiffness, model_.added_pressure);
    record.viscosity = fields_.viscosity[i];
    set(record, FlowRecord::velocity(), particles_.velocity[i]);
    set(record, FlowRecord::transport(), transport_[i]);
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
void ClosedFlow::evaluate_in(double dt) {
  if (dt > 0 && model_.density_relaxation > 0) {
    continue_density<D>(dt);
  } else {
    sum_density<D>();
  }
  const auto mirror = [](FlowRecord& image, const Ghost& ghost) {
    set(image, FlowRecord::velocity(), ghost.mirrored(get(image, FlowRecord::velocity())));
    set(image, FlowRecord::transport(), ghost.mirrored(get(image, FlowRecord::transport())));
  };
  fill_records();
  // Walls read the fluid's images, then everybody reads those of the walls.
  fill_images(records_, mirror);
  extrapolate_to_walls<D>();
  fill_images(records_, mirror);
  if (model_.interface) {
    sum_interface<D>();
  }
  sum_forces<D>();
  if (model_.heat) {
    conduct_heat<D>();
  }
}

void ClosedFlow::evaluate_after(double dt) {
  if (particles_.dimensions == 2) {
    evaluate_in<2>(dt);
  } else {
    evaluate_in<3>(dt);
  }
}

}  // namespace meltproof::solver

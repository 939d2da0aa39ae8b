// SPDX-License-Identifier: GPL-3.0-or-later
// What the wall feels, and the forces on the melt.
#include <algorithm>
#include <cmath>

#include "solver/flow/free_surface.hpp"
#include "solver/flow/separation.hpp"

namespace meltproof::solver {

void FreeSurfaceFlow::walls_and_missing_gradients(const std::vector<Ghost>& ghosts) {
  const ForceRecord* all = force_.data();
  const auto feel = [&](std::size_t member) {
    const std::uint32_t i = wall_slot_[member];
    const ForceRecord& own = all[i];
    WallSums<Lane> sums;
    for (std::size_t k = melt_near_wall_.first[member]; k < melt_near_wall_.last[member];
         k += lane_count) {
      const std::uint32_t* j = &melt_near_wall_.index[k];
      const Lane density = gather(all, j, &ForceRecord::density);
      const auto [dx, dy, dz, r2, r] = separation(own, all, j);
      const Lane w = where_positive(density, kernel_.value(r), Lane(0.0));
      wall_pair(sums, w, dx, dy, dz, gather(all, j, &ForceRecord::pressure), density,
                gather(all, j, &ForceRecord::vx), gather(all, j, &ForceRecord::vy),
                gather(all, j, &ForceRecord::vz));
    }
    const WallSums<double> sum{sum_lanes(sums.weight),     sum_lanes(sums.pressure),
                               sum_lanes(sums.moment_x),   sum_lanes(sums.moment_y),
                               sum_lanes(sums.moment_z),   sum_lanes(sums.velocity_x),
                               sum_lanes(sums.velocity_y), sum_lanes(sums.velocity_z)};
    const double pressure =
        wall_pressure(sum, settings_.gravity[0], settings_.gravity[1], settings_.gravity[2]);
    // A wall that pulled would hold the melt where physics lets it go.
    limited_[i] = pressure < 0 ? 1 : 0;
    pressure_[i] = std::max(0.0, pressure);
    ForceRecord& record = force_[i];
    record.pressure = pressure_[i];
    record.vx = wall_velocity(0, sum.velocity_x, sum.weight);
    record.vy = wall_velocity(0, sum.velocity_y, sum.weight);
    record.vz = wall_velocity(0, sum.velocity_z, sum.weight);
  };
  compute_and_exchange(
      Halo::wall, 4,
      [&](Part part) {
        for_each_of(wall_parts_, part, wall_.size(), feel);
        if (part == Part::inner) {
          missing_gradients();  // of the melt's own pressure alone: needs no wall
        }
      },
      [&](std::uint32_t i, double* out) {
        const ForceRecord& record = force_[slot_[i]];
        out[0] = record.pressure;
        out[1] = record.vx;
        out[2] = record.vy;
        out[3] = record.vz;
      },
      [&](std::uint32_t i, const double* in) {
        ForceRecord& record = force_[slot_[i]];
        record.pressure = in[0];
        record.vx = in[1];
        record.vy = in[2];
        record.vz = in[3];
      });
  for_each_image(ghosts, [&](std::uint32_t s, const Ghost& ghost, std::uint32_t source) {
    if (role_[ghost.source] == 2) {
      const ForceRecord& wall = force_[source];
      const Vector v = ghost.mirrored({wall.vx, wall.vy, wall.vz});
      ForceRecord& image = force_[s];
      image.pressure = wall.pressure;
      image.vx = v[0];
      image.vy = v[1];
      image.vz = v[2];
    }
  });
}

void FreeSurfaceFlow::forces(const Particles& particles) {
  const ForceRecord* all = force_.data();
  const QuinticSpline half(kernel_.smoothing_length / 2, dimensions_);
  const bool repel = settings_.cure == ClumpingCure::repulsion && settings_.repulsion > 0;
  const double over_onset = 1 / kernel_.value(settings_.repulsion_distance * spacing_);
  const bool transport = settings_.cure == ClumpingCure::transport;
  const double shifting = settings_.shifting * settings_.sound_speed * kernel_.smoothing_length;
  // Of c^2: beyond some 2 c^2 the stiffest disorder overshoots within one acoustic step.
  const double stiffest = 0.2 * settings_.sound_speed * settings_.sound_speed;
  const double artificial =
      settings_.artificial_viscosity * settings_.sound_speed * kernel_.smoothing_length / 2;
  for_each_sum(liquid_.size(), [&](std::size_t member) {
    const std::uint32_t i = liquid_slot_[member];
    const ForceRecord& own = all[i];
    const Vector& out = normal_[i];
    const bool interior = out[0] == 0 && out[1] == 0 && out[2] == 0;
    const bool shift = transport || (settings_.shifting > 0 && interior);
    Lane strain = 0, ax = 0, ay = 0, az = 0, sx = 0, sy = 0, sz = 0;
    const Lane own_square = own.volume * own.volume;
    for (std::size_t k = near_.first[member]; k < near_.last[member]; k += lane_count) {
      const std::uint32_t* j = &near_.index[k];
      const auto [dx, dy, dz, r2, r] = separation(own, all, j);
      const Lane ux = own.vx - gather(all, j, &ForceRecord::vx);
      const Lane uy = own.vy - gather(all, j, &ForceRecord::vy);
      const Lane uz = own.vz - gather(all, j, &ForceRecord::vz);
      const Lane volume = gather(all, j, &ForceRecord::volume);
      const Lane other = gather(all, j, &ForceRecord::density);
      // Walls take the fluid's density and viscosity in the pair.
      const Lane density = where_positive(other, other, Lane(own.density));
      const Lane viscosity =
          where_positive(other, gather(all, j, &ForceRecord::viscosity), Lane(own.viscosity));
      const Lane squares = own_square + volume * volume, slope_over_r = kernel_.slope(r) / r;
      Lane pressure = pressure_pair(Lane(own.pressure), Lane(own.density),
                                    gather(all, j, &ForceRecord::pressure), density);
      if (repel) {
        pressure += repulsion_pair(kernel_.value(r) * over_onset, settings_.repulsion);
      }
      const Lane approach = dx * ux + dy * uy + dz * uz;
      if (artificial > 0) {
        pressure +=
            artificial * own.density * positive_part(-approach) / (r2 + kernel_.regularisation);
      }
      const Lane rub = viscosity_pair(Lane(own.viscosity), viscosity) *
                       central_viscosity(slope_over_r, kernel_.second_moment, dimensions_);
      const Lane along = squares * (rub * approach - slope_over_r * pressure);
      ax += along * dx;
      ay += along * dy;
      az += along * dz;
      if (shift) {
        // |grad v|^2 of a linear velocity, as minus the sum of V W'/r r r^T is the unit matrix.
        strain -= volume * slope_over_r * (ux * ux + uy * uy + uz * uz);
        const Lane push = squares * half.slope(r) / r;
        sx += push * dx;
        sy += push * dy;
        sz += push * dz;
      }
    }
    const double mass = particles.mass[liquid_[member]];
    Vector& a = acceleration_[i];
    a = {sum_lanes(ax) / mass, sum_lanes(ay) / mass, sum_lanes(az) / mass};
    shift_[i] = {};
    if (shift) {
      const double background = std::max(
          transport ? std::min(10 * std::abs(own.pressure), settings_.transport_pressure) : 0,
          interior ? own.density * std::min(shifting * std::sqrt(sum_lanes(strain)), stiffest) : 0);
      shift_[i] = {-background * sum_lanes(sx) / mass, -background * sum_lanes(sy) / mass,
                   -background * sum_lanes(sz) / mass};
      // Beyond the surface nothing pushes back: only along it may it even out places.
      const double across = shift_[i][0] * out[0] + shift_[i][1] * out[1] + shift_[i][2] * out[2];
      for (std::size_t d = 0; d < 3; ++d) {
        shift_[i][d] -= across * out[d];
      }
    }
    double inward = 0;
    if (settings_.surface_tension) {
      inward += melt_[i].surface_tension * curvature_[i];
    }
    if (settings_.recoil) {
      inward += melt_[i].recoil;
    }
    const double area_over_mass = area_[i] / mass, volume_over_mass = 1 / own.density;
    for (std::size_t d = 0; d < 3; ++d) {
      a[d] += settings_.gravity[d] - pull_[i] / mass * inward * normal_[i][d] -
              volume_over_mass * missing_gradient_[i][d];
      if (settings_.marangoni && area_[i] > 0) {
        a[d] += area_over_mass * tension_gradient_[i][d];
      }
    }
  });
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// Normals, curvature, area, and the gradient of the surface tension.
#include <algorithm>
#include <cmath>

#include "solver/flow/free_surface.hpp"
#include "solver/flow/separation.hpp"

namespace meltproof::solver {

void FreeSurfaceFlow::write_surface(const Particles& particles, const std::vector<Ghost>& ghosts) {
  for_each_particle(particle_.size(), [&](std::size_t s) {
    const Vector &at = particles.position[particle_[s]], &c = colour_[s];
    const double size = std::sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
    const double strength = size * kernel_.smoothing_length;
    SurfaceRecord& record = surface_[s];
    record = {at[0], at[1], at[2], 0, 0, 0, melt_[s].surface_tension, 0};
    normal_[s] = {};
    if (strength >= interface_threshold) {
      // The colour gradient points into the metal.
      normal_[s] = {-c[0] / size, -c[1] / size, -c[2] / size};
      record.nx = normal_[s][0];
      record.ny = normal_[s][1];
      record.nz = normal_[s][2];
      record.depth = depth_(strength) * kernel_.smoothing_length;
    }
  });
  const auto write_images = [&] {
    for_each_image(ghosts, [&](std::uint32_t s, const Ghost& ghost, std::uint32_t source) {
      const SurfaceRecord& record = surface_[source];
      const Vector at = ghost.image_of(particles.position[ghost.source]);
      const Vector normal = ghost.mirrored({record.nx, record.ny, record.nz});
      surface_[s] = {at[0],     at[1],     at[2],          normal[0],
                     normal[1], normal[2], record.tension, record.depth};
    });
  };
  write_images();
  leave_disorder_out();
  write_images();
}

/// A weak colour gradient is the second layer's, or the disorder of the interior: there tension
/// would draw clumps together. Only what lies right below an outermost particle counts.
void FreeSurfaceFlow::leave_disorder_out() {
  const SurfaceRecord* all = surface_.data();
  const double outermost = outermost_depth_ * kernel_.smoothing_length;
  const double near = std::pow(below_outermost * kernel_.smoothing_length, 2);
  const auto look = [&](std::uint32_t i, const std::uint32_t* begin, const std::uint32_t* end) {
    const SurfaceRecord& own = all[i];
    disorder_[i] = 0;
    if (own.depth <= outermost) {
      return;
    }
    for (const std::uint32_t* j = begin; j < end; j += lane_count) {
      const Lane depth = gather(all, j, &SurfaceRecord::depth);
      const auto outer = depth > 0.0 && depth < outermost;
      if (!any_of(outer)) {
        continue;
      }
      const Lane dx = own.x - gather(all, j, &SurfaceRecord::x);
      const Lane dy = own.y - gather(all, j, &SurfaceRecord::y);
      const Lane dz = own.z - gather(all, j, &SurfaceRecord::z);
      if (any_of(outer && dx * dx + dy * dy + dz * dz < near)) {
        return;
      }
    }
    disorder_[i] = 1;
  };
  compute_and_exchange(
      Halo::metal_near_melt, 1,
      [&](Part part) {
        for_each_of(liquid_parts_, part, liquid_.size(), [&](std::size_t k) {
          look(liquid_slot_[k], near_.index.data() + near_.first[k],
               near_.index.data() + near_.last[k]);
        });
        for_each_of(wall_parts_, part, wall_.size(), [&](std::size_t k) {
          const std::uint32_t i = wall_slot_[k];
          look(i, list_.index.data() + list_.first[i], list_.index.data() + list_.last[i]);
        });
      },
      [&](std::uint32_t i, double* out) { *out = disorder_[slot_[i]]; },
      [&](std::uint32_t i, const double* in) { disorder_[slot_[i]] = *in > 0 ? 1 : 0; });
  for_each_particle(particle_.size(), [&](std::size_t s) {
    if (disorder_[s] != 0) {
      surface_[s].depth = surface_[s].nx = surface_[s].ny = surface_[s].nz = 0;
      normal_[s] = {};
    }
  });
}

void FreeSurfaceFlow::set_properties(const Particles& particles, const std::vector<Ghost>& ghosts) {
  write_motion(particles, ghosts);
  find_near();
  // Walls stand still and melt moves little between two calls, so their normals are kept until the
  // next one.
  colour_gradients();
  halo_.exchange(
      Halo::metal_near_melt, 3,
      [&](std::uint32_t i, double* out) { std::copy_n(colour_[slot_[i]].begin(), 3, out); },
      [&](std::uint32_t i, const double* in) { std::copy_n(in, 3, colour_[slot_[i]].begin()); });
  if (settings_.density_diffusion > 0 && settings_.diffusion_form == DensityDiffusion::corrected) {
    density_gradients(ghosts);
  }
  if (!settings_.marangoni) {
    return;
  }
  write_surface(particles, ghosts);
  const SurfaceRecord* all = surface_.data();
  for_each_sum(liquid_.size(), [&](std::size_t member) {
    const std::uint32_t i = liquid_slot_[member];
    const SurfaceRecord& own = all[i];
    tension_gradient_[i] = {};
    if (own.depth <= 0) {
      return;
    }
    GradientSums sums;
    for (std::size_t k = near_.first[member]; k < near_.last[member]; k += lane_count) {
      const std::uint32_t* j = &near_.index[k];
      const auto [dx, dy, dz, r2, r] = separation(own, all, j);
      const Lane factor = softened_slope(kernel_, r, r2);
      sums.add(factor, own.tension - gather(all, j, &SurfaceRecord::tension), dx, dy, dz);
    }
    tension_gradient_[i] = surface_gradient(sums.total(), normal_[i]);
  });
}

void FreeSurfaceFlow::curvatures(const std::vector<Ghost>& ghosts) {
  const SurfaceRecord* all = surface_.data();
  const double h = kernel_.smoothing_length, outermost = outermost_depth_ * h;
  const auto bend_of = [&](std::size_t member) {
    const std::uint32_t i = liquid_slot_[member];
    const SurfaceRecord& own = all[i];
    area_[i] = pull_[i] = curvature_[i] = 0;
    outer_curvature_[i] = {};
    limited_[i] = 0;
    if (own.depth <= 0) {
      return;
    }
    Lane turn = 0, reach = 0, inset = 0;
    for (std::size_t k = near_.first[member]; k < near_.last[member]; k += lane_count) {
      const std::uint32_t* j = &near_.index[k];
      const Lane depth = gather(all, j, &SurfaceRecord::depth);
      const auto [dx, dy, dz, r2, r] = separation(own, all, j);
      const Lane factor = where_positive(depth, softened_slope(kernel_, r, r2), Lane(0.0)) *
                          normal_weight(depth, outermost, below_outermost * h);
      const Lane across = dx * own.nx + dy * own.ny + dz * own.nz;
      const Lane tx = dx - across * own.nx, ty = dy - across * own.ny, tz = dz - across * own.nz;
      const Lane bend = factor * ((own.nx - gather(all, j, &SurfaceRecord::nx)) * tx +
                                  (own.ny - gather(all, j, &SurfaceRecord::ny)) * ty +
                                  (own.nz - gather(all, j, &SurfaceRecord::nz)) * tz);
      turn += bend;
      inset += depth * bend;
      reach += factor * (tx * tx + ty * ty + tz * tz);
    }
    InterfaceSums sums;
    sums.turn = sum_lanes(turn);
    sums.reach = sum_lanes(reach);
    sums.inset = sum_lanes(inset);
    const Vector& c = colour_[i];
    const double size = std::sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
    bool limited = false;
    curvature_[i] = surface_curvature(sums, dimensions_, depth_.per_curvature(size * h) * h * h,
                                      spacing_, limited);
    limited_[i] = limited ? 1 : 0;
    pull_[i] = 2 * size * motion_[i].volume;
    area_[i] = surface_area(pull_[i], curvature_[i], own.depth);
    if (own.depth <= outermost) {
      outer_curvature_[i] = {pull_[i] * curvature_[i], pull_[i]};
    }
  };
  compute_and_exchange(
      Halo::liquid, 2,
      [&](Part part) { for_each_of(liquid_parts_, part, liquid_.size(), bend_of); },
      [&](std::uint32_t i, double* out) {
        out[0] = outer_curvature_[slot_[i]].curvature;
        out[1] = outer_curvature_[slot_[i]].weight;
      },
      [&](std::uint32_t i, const double* in) {
        outer_curvature_[slot_[i]] = {in[0], in[1]};
      });
  for (std::size_t g = 0; g < near_ghosts_.size(); ++g) {
    outer_curvature_[particle_.size() + g] =
        outer_curvature_[slot_[ghosts[near_ghosts_[g]].source]];
  }
  curvatures_below();
  // Forces take area_: what blows off a ball of spray all around does not push it.
  for_each_particle(liquid_.size(), [&](std::size_t member) {
    const std::uint32_t i = liquid_slot_[member];
    exposed_[i] =
        exposed_area(area_[i], filled_[i] + alone_, alone_, motion_[i].volume, dimensions_);
  });
}

/// Below the outermost layer, the mean of those of the outermost layer in reach: the own normal is
/// too uncertain there. Under a sphere both are the same. Where only a wall's surface is in reach,
/// the own one stays.
void FreeSurfaceFlow::curvatures_below() {
  const SurfaceRecord* all = surface_.data();
  const double outermost = outermost_depth_ * kernel_.smoothing_length;
  for_each_sum(liquid_.size(), [&](std::size_t member) {
    const std::uint32_t i = liquid_slot_[member];
    const SurfaceRecord& own = all[i];
    if (own.depth <= outermost) {
      return;
    }
    Lane sum = 0, weight = 0;
    for (std::size_t k = near_.first[member]; k < near_.last[member]; k += lane_count) {
      const std::uint32_t* j = &near_.index[k];
      const auto [dx, dy, dz, r2, r] = separation(own, all, j);
      const Lane near = kernel_.value(r);
      sum += near * gather(outer_curvature_.data(), j, &CurvatureRecord::curvature);
      weight += near * gather(outer_curvature_.data(), j, &CurvatureRecord::weight);
    }
    if (const double whole = sum_lanes(weight); whole > 0) {
      curvature_[i] = sum_lanes(sum) / whole;
      area_[i] = surface_area(pull_[i], curvature_[i], own.depth);
      limited_[i] = 0;
    }
  });
}

/// What the neighbours that the outermost layer lacks would carry of the pressure's gradient along
/// the surface: that layer feels only 0.78 of it, so a drop swings too slowly. Of the melt's own
/// pressure, which sound has smoothed: taken from the capillary pressure of the surface the force
/// follows every ripple of the curvature, and a drop of 12 spacings shakes itself to pieces.
void FreeSurfaceFlow::missing_gradients() {
  if (!settings_.surface_tension && !settings_.recoil) {
    return;  // nothing acts on the surface, so the pressure there is zero all along it
  }
  const SurfaceRecord* all = surface_.data();
  for_each_sum(liquid_.size(), [&](std::size_t member) {
    const std::uint32_t i = liquid_slot_[member];
    const SurfaceRecord& own = all[i];
    missing_gradient_[i] = {};
    if (own.depth <= 0) {
      return;
    }
    GradientSums sums;
    Lane spread = 0;
    for (std::size_t k = near_.first[member]; k < near_.last[member]; k += lane_count) {
      const std::uint32_t* j = &near_.index[k];
      const auto [dx, dy, dz, r2, r] = separation(own, all, j);
      const Lane slope = softened_slope(kernel_, r, r2);
      const Lane melt = gather(force_.data(), j, &ForceRecord::density);
      sums.add(where_positive(melt, slope, Lane(0.0)),
               pressure_[i] - gather(force_.data(), j, &ForceRecord::pressure), dx, dy, dz);
      const Lane across = dx * own.nx + dy * own.ny + dz * own.nz;
      spread += gather(motion_.data(), j, &MotionRecord::volume) * slope * (r2 - across * across);
    }
    const double missing = missing_support(sum_lanes(spread), dimensions_);
    const Vector gradient = surface_gradient(sums.total(), normal_[i]);
    for (std::size_t d = 0; d < 3; ++d) {
      missing_gradient_[i][d] = missing * gradient[d];
    }
  });
}

}  // namespace meltproof::solver

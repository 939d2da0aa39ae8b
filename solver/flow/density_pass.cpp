// SPDX-License-Identifier: GPL-3.0-or-later
// Continuity, density diffusion and the colour gradient.
#include <algorithm>
#include <cmath>

#include "solver/flow/free_surface.hpp"
#include "solver/flow/separation.hpp"

namespace meltproof::solver {

void FreeSurfaceFlow::colour_gradients() {
  const MotionRecord* all = motion_.data();
  const auto look = [&](std::uint32_t i, const std::uint32_t* begin, const std::uint32_t* end) {
    const MotionRecord& own = all[i];
    Lane filled = 0, cx = 0, cy = 0, cz = 0;
    for (const std::uint32_t* j = begin; j < end; j += lane_count) {
      const auto [dx, dy, dz, r2, r] = separation(own, all, j);
      const Lane volume = gather(all, j, &MotionRecord::volume);
      const Lane weight = volume * kernel_.slope(r) / r;
      filled += volume * kernel_.value(r);
      cx += weight * dx;
      cy += weight * dy;
      cz += weight * dz;
    }
    colour_[i] = {sum_lanes(cx), sum_lanes(cy), sum_lanes(cz)};
    filled_[i] = sum_lanes(filled) / lattice_sum_;
  };
  for_each_sum(wall_.size(), [&](std::size_t member) {
    const std::uint32_t i = wall_slot_[member];
    look(i, list_.index.data() + list_.first[i], list_.index.data() + list_.last[i]);
  });
  for_each_sum(liquid_.size(), [&](std::size_t member) {
    look(liquid_slot_[member], near_.index.data() + near_.first[member],
         near_.index.data() + near_.last[member]);
  });
}

/// Of the smooth profile, once per call of set_properties(): it changes little within a few steps,
/// and an old one damps a little less but never excites.
void FreeSurfaceFlow::density_gradients(const std::vector<Ghost>& ghosts) {
  const MotionRecord* all = motion_.data();
  for_each_sum(liquid_.size(), [&](std::size_t member) {
    const std::uint32_t i = liquid_slot_[member];
    const MotionRecord& own = all[i];
    GradientSums sums;
    for (std::size_t k = near_.first[member]; k < near_.last[member]; k += lane_count) {
      const std::uint32_t* j = &near_.index[k];
      const auto [dx, dy, dz, r2, r] = separation(own, all, j);
      const Lane density = gather(all, j, &MotionRecord::density);
      const Lane factor = where_positive(density, softened_slope(kernel_, r, r2), Lane(0.0));
      sums.add(factor, own.density - density, dx, dy, dz);
    }
    const Vector gradient = surface_gradient(sums.total(), {});
    density_gradient_[i] = {gradient[0], gradient[1], gradient[2]};
  });
  halo_.exchange(
      Halo::liquid, 3,
      [&](std::uint32_t i, double* out) {
        const DensityRecord& gradient = density_gradient_[slot_[i]];
        out[0] = gradient.x;
        out[1] = gradient.y;
        out[2] = gradient.z;
      },
      [&](std::uint32_t i, const double* in) {
        density_gradient_[slot_[i]] = {in[0], in[1], in[2]};
      });
  for_each_image(ghosts, [&](std::uint32_t s, const Ghost& ghost, std::uint32_t source) {
    const DensityRecord& gradient = density_gradient_[source];
    const Vector image = ghost.mirrored({gradient.x, gradient.y, gradient.z});
    density_gradient_[s] = {image[0], image[1], image[2]};
  });
}

void FreeSurfaceFlow::densities(Particles& particles, double dt) {
  const MotionRecord* all = motion_.data();
  const DensityRecord* gradients = density_gradient_.data();
  const bool corrected = settings_.diffusion_form == DensityDiffusion::corrected;
  const double diffusion =
      settings_.density_diffusion * kernel_.smoothing_length * settings_.sound_speed;
  const bool relax = settings_.density_relaxation > 0;
  const double relaxation =
      !relax ? 0
             : settings_.sound_speed / (settings_.density_relaxation * kernel_.smoothing_length);
  const double at_centre = kernel_.value(0.0);
  const auto advance = [&](std::size_t member) {
    const std::uint32_t i = liquid_slot_[member], particle = liquid_[member];
    const MotionRecord& own = all[i];
    const DensityRecord& gradient = gradients[i];
    const double mass = particles.mass[particle], reference = mass / particles.volume[particle];
    Lane compression = 0, diffused = 0, summed = 0, filled = 0, cx = 0, cy = 0, cz = 0;
    for (std::size_t k = near_.first[member]; k < near_.last[member]; k += lane_count) {
      const std::uint32_t* j = &near_.index[k];
      const auto [dx, dy, dz, r2, r] = separation(own, all, j);
      const Lane ux = own.vx - gather(all, j, &MotionRecord::vx);
      const Lane uy = own.vy - gather(all, j, &MotionRecord::vy);
      const Lane uz = own.vz - gather(all, j, &MotionRecord::vz);
      const Lane volume = gather(all, j, &MotionRecord::volume);
      const Lane density = gather(all, j, &MotionRecord::density);
      const Lane slope = kernel_.slope(r), slope_over_r = slope / r;
      compression += continuity_pair(volume, slope_over_r, dx * ux + dy * uy + dz * uz);
      const Lane factor = r * slope / (r2 + kernel_.regularisation);
      Lane smooth = 0;
      if (corrected) {
        smooth = 0.5 * ((gradient.x + gather(gradients, j, &DensityRecord::x)) * dx +
                        (gradient.y + gather(gradients, j, &DensityRecord::y)) * dy +
                        (gradient.z + gather(gradients, j, &DensityRecord::z)) * dz);
      }
      diffused += where_positive(
          density, density_diffusion_pair(Lane(own.density), density, smooth, volume, factor),
          Lane(0.0));
      const Lane share = volume * kernel_.value(r);
      filled += share;
      // Walls take the melt's density at rest.
      summed += share * where_positive(density, density, Lane(reference));
      cx += volume * slope_over_r * dx;
      cy += volume * slope_over_r * dy;
      cz += volume * slope_over_r * dz;
    }
    colour_[i] = {sum_lanes(cx), sum_lanes(cy), sum_lanes(cz)};
    filled_[i] = sum_lanes(filled) / lattice_sum_;
    double rate = own.density * sum_lanes(compression) + diffusion * sum_lanes(diffused);
    if (relax) {
      const double sum = (sum_lanes(summed) + mass * at_centre) / lattice_sum_;
      // The colour gradient counts volumes as they are now, the sum masses.
      const double strength =
          std::hypot(colour_[i][0], colour_[i][1], colour_[i][2]) * kernel_.smoothing_length;
      rate += relaxation * density_excess(sum / depth_.covered(strength * own.density / sum),
                                          own.density, reference);
    }
    particles.density[particle] += dt * rate;
  };
  compute_and_exchange(
      Halo::liquid, 4,
      [&](Part part) { for_each_of(liquid_parts_, part, liquid_.size(), advance); },
      [&](std::uint32_t i, double* out) {
        out[0] = particles.density[i];
        std::copy_n(colour_[slot_[i]].begin(), 3, out + 1);
      },
      [&](std::uint32_t i, const double* in) {
        particles.density[i] = in[0];
        std::copy_n(in + 1, 3, colour_[slot_[i]].begin());
      });
}

}  // namespace meltproof::solver

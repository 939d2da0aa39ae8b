// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flow/free_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "solver/particles/block_sum.hpp"

namespace meltproof::solver {

FreeSurfaceFlow::FreeSurfaceFlow(const FlowSettings& settings, const QuinticSpline& kernel,
                                 double spacing, int dimensions)
    : settings_(settings),
      kernel_(kernel),
      spacing_(spacing),
      kernel_at_spacing_(kernel.value(spacing)),
      dimensions_(dimensions) {}

void FreeSurfaceFlow::arrange(const Particles& particles, const std::vector<Ghost>& ghosts,
                              const NeighbourList& list, bool everything) {
  const std::size_t n = particles.size(), all = list.void_index + std::size_t{1};
  // Whoever had a role before may have lost it; the records of all others still hold.
  std::vector<std::uint32_t> changed;
  if (everything || role_.size() != n) {
    changed.resize(n);
    std::iota(changed.begin(), changed.end(), 0U);
  } else {
    changed = liquid_;
    changed.insert(changed.end(), wall_.begin(), wall_.end());
  }
  role_.assign(n, 0);
  liquid_.clear();
  wall_.clear();
  for (std::uint32_t i = 0; i < n; ++i) {
    if (particles.phase[i] == Phase::liquid) {
      liquid_.push_back(i);
      role_[i] = 1;
    }
  }
  for (const std::uint32_t i : liquid_) {
    for (std::size_t k = list.first[i]; k < list.last[i]; ++k) {
      const std::uint32_t j = list.index[k];
      if (j == list.void_index) {
        continue;
      }
      const std::uint32_t source = j < n ? j : ghosts[j - n].source;
      if (role_[source] == 0 && particles.phase[source] == Phase::solid) {
        role_[source] = 2;
        wall_.push_back(source);
      }
    }
  }
  std::sort(wall_.begin(), wall_.end());
  // A wall listens to the melt only, which is a small part of its list.
  melt_near_wall_.first.clear();
  melt_near_wall_.last.clear();
  melt_near_wall_.index.clear();
  for (const std::uint32_t i : wall_) {
    const std::size_t begin = melt_near_wall_.index.size();
    melt_near_wall_.first.push_back(begin);
    for (std::size_t k = list.first[i]; k < list.last[i]; ++k) {
      const std::uint32_t j = list.index[k];
      if (j != list.void_index && role_[j < n ? j : ghosts[j - n].source] == 1) {
        melt_near_wall_.index.push_back(j);
      }
    }
    while ((melt_near_wall_.index.size() - begin) % lane_count != 0) {
      melt_near_wall_.index.push_back(list.void_index);
    }
    melt_near_wall_.last.push_back(melt_near_wall_.index.size());
  }
  near_ghosts_.clear();
  for (std::uint32_t g = 0; g < ghosts.size(); ++g) {
    if (role_[ghosts[g].source] != 0) {
      near_ghosts_.push_back(g);
    }
  }
  for (auto* field : {&area_, &curvature_, &pressure_}) {
    field->resize(n, 0.0);
  }
  for (auto* field : {&colour_, &normal_, &tension_gradient_, &acceleration_, &shift_}) {
    field->resize(n, Vector{});
  }
  limited_.assign(n, 0);
  // Solids stand still, so their records are written here and not again. Behind everybody stands
  // the void.
  for (const std::uint32_t i : wall_) {
    changed.push_back(i);
  }
  motion_.resize(all);
  density_gradient_.resize(all);
  surface_.resize(all);
  force_.resize(all);
  // One thread: an index may stand in the list twice.
  for (const std::uint32_t i : changed) {
    const Vector& at = particles.position[i];
    // What was lost takes part in nothing.
    const bool here = particles.phase[i] != Phase::lost;
    motion_[i] =
        here ? MotionRecord{at[0], at[1], at[2], 0, 0, 0, particles.volume[i], 0} : MotionRecord{};
    surface_[i] = here ? SurfaceRecord{at[0], at[1], at[2], 0, 0, 0, 0, 0} : SurfaceRecord{};
    force_[i] = ForceRecord{};
    if (role_[i] != 1) {
      area_[i] = curvature_[i] = pressure_[i] = 0;
      normal_[i] = acceleration_[i] = shift_[i] = tension_gradient_[i] = {};
    }
    if (role_[i] == 2) {
      force_[i] = ForceRecord{at[0], at[1], at[2], 0, 0, 0, particles.volume[i], 0, 0, 0};
    }
  }
  for (std::size_t g = 0; g < ghosts.size(); ++g) {
    const std::uint32_t source = ghosts[g].source;
    const Vector at = ghosts[g].image_of(particles.position[source]);
    motion_[n + g] = motion_[source];
    surface_[n + g] = surface_[source];
    force_[n + g] = force_[source];
    const DensityRecord& gradient = density_gradient_[source];
    const Vector image = ghosts[g].mirrored({gradient.x, gradient.y, gradient.z});
    density_gradient_[n + g] = {image[0], image[1], image[2]};
    motion_[n + g].x = surface_[n + g].x = at[0];
    motion_[n + g].y = surface_[n + g].y = at[1];
    motion_[n + g].z = surface_[n + g].z = at[2];
    if (role_[source] == 2) {
      force_[n + g].x = at[0];
      force_[n + g].y = at[1];
      force_[n + g].z = at[2];
    }
  }
  motion_.back() = MotionRecord{};
  density_gradient_.back() = DensityRecord{};
  surface_.back() = SurfaceRecord{};
  force_.back() = ForceRecord{};
}

void FreeSurfaceFlow::write_motion(const Particles& particles, const std::vector<Ghost>& ghosts) {
  for_each_particle(liquid_.size(), [&](std::size_t k) {
    const std::uint32_t i = liquid_[k];
    const Vector &at = particles.position[i], &v = particles.velocity[i];
    motion_[i] = {at[0],
                  at[1],
                  at[2],
                  v[0],
                  v[1],
                  v[2],
                  particles.mass[i] / particles.density[i],
                  particles.density[i]};
  });
  const std::size_t n = particles.size();
  for (const std::uint32_t g : near_ghosts_) {
    const std::uint32_t source = ghosts[g].source;
    const Vector at = ghosts[g].image_of(particles.position[source]);
    const Vector v = ghosts[g].mirrored(particles.velocity[source]);
    motion_[n + g] = {
        at[0], at[1], at[2], v[0], v[1], v[2], motion_[source].volume, motion_[source].density};
  }
}

void FreeSurfaceFlow::kick_and_drift(Particles& particles, double dt) {
  for_each_particle(liquid_.size(), [&](std::size_t k) {
    const std::uint32_t i = liquid_[k];
    for (std::size_t d = 0; d < 3; ++d) {
      particles.velocity[i][d] += dt / 2 * acceleration_[i][d];
      particles.position[i][d] += dt * (particles.velocity[i][d] + shift_[i][d]);
    }
  });
}

/// Of the smooth profile, once per call of set_properties(): it changes little within a few steps,
/// and an old one damps a little less but never excites.
void FreeSurfaceFlow::density_gradients(const Particles& particles,
                                        const std::vector<Ghost>& ghosts,
                                        const NeighbourList& list) {
  const MotionRecord* all = motion_.data();
  for_each_particle(liquid_.size(), [&](std::size_t member) {
    const std::uint32_t i = liquid_[member];
    const MotionRecord& own = all[i];
    Lane bx = 0, by = 0, bz = 0, xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
    for (std::size_t k = list.first[i]; k < list.last[i]; k += lane_count) {
      const std::uint32_t* j = &list.index[k];
      const Lane dx = own.x - gather(all, j, &MotionRecord::x);
      const Lane dy = own.y - gather(all, j, &MotionRecord::y);
      const Lane dz = own.z - gather(all, j, &MotionRecord::z);
      const Lane density = gather(all, j, &MotionRecord::density);
      const Lane r2 = dx * dx + dy * dy + dz * dz;
      const Lane r = square_root(larger(r2, Lane(1e-40)));
      const Lane factor =
          where_positive(density, r * kernel_.slope(r) / (r2 + kernel_.regularisation), Lane(0.0));
      const Lane change = factor * (own.density - density);
      bx += change * dx;
      by += change * dy;
      bz += change * dz;
      xx += factor * dx * dx;
      yy += factor * dy * dy;
      zz += factor * dz * dz;
      xy += factor * dx * dy;
      xz += factor * dx * dz;
      yz += factor * dy * dz;
    }
    InterfaceSums sums;
    sums.difference = {sum_lanes(bx), sum_lanes(by), sum_lanes(bz)};
    sums.moment = {sum_lanes(xx), sum_lanes(yy), sum_lanes(zz),
                   sum_lanes(xy), sum_lanes(xz), sum_lanes(yz)};
    const Vector gradient = surface_gradient(sums, {});
    density_gradient_[i] = {gradient[0], gradient[1], gradient[2]};
  });
  const std::size_t n = particles.size();
  for (const std::uint32_t g : near_ghosts_) {
    const DensityRecord& source = density_gradient_[ghosts[g].source];
    const Vector image = ghosts[g].mirrored({source.x, source.y, source.z});
    density_gradient_[n + g] = {image[0], image[1], image[2]};
  }
}

void FreeSurfaceFlow::densities(Particles& particles, const NeighbourList& list, double dt) {
  const MotionRecord* all = motion_.data();
  const DensityRecord* gradients = density_gradient_.data();
  const bool corrected = settings_.diffusion_form == DensityDiffusion::corrected;
  const double diffusion =
      settings_.density_diffusion * kernel_.smoothing_length * settings_.sound_speed;
  for_each_particle(liquid_.size(), [&](std::size_t member) {
    const std::uint32_t i = liquid_[member];
    const MotionRecord& own = all[i];
    const DensityRecord& gradient = gradients[i];
    Lane compression = 0, diffused = 0, cx = 0, cy = 0, cz = 0;
    for (std::size_t k = list.first[i]; k < list.last[i]; k += lane_count) {
      const std::uint32_t* j = &list.index[k];
      const Lane dx = own.x - gather(all, j, &MotionRecord::x);
      const Lane dy = own.y - gather(all, j, &MotionRecord::y);
      const Lane dz = own.z - gather(all, j, &MotionRecord::z);
      const Lane ux = own.vx - gather(all, j, &MotionRecord::vx);
      const Lane uy = own.vy - gather(all, j, &MotionRecord::vy);
      const Lane uz = own.vz - gather(all, j, &MotionRecord::vz);
      const Lane volume = gather(all, j, &MotionRecord::volume);
      const Lane density = gather(all, j, &MotionRecord::density);
      const Lane r2 = dx * dx + dy * dy + dz * dz;
      const Lane r = square_root(larger(r2, Lane(1e-40)));
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
      cx += volume * slope_over_r * dx;
      cy += volume * slope_over_r * dy;
      cz += volume * slope_over_r * dz;
    }
    const double rate = own.density * sum_lanes(compression) + diffusion * sum_lanes(diffused);
    particles.density[i] += dt * rate;
    colour_[i] = {sum_lanes(cx), sum_lanes(cy), sum_lanes(cz)};
  });
}

void FreeSurfaceFlow::colour_gradients(const NeighbourList& list,
                                       const std::vector<std::uint32_t>& members) {
  const MotionRecord* all = motion_.data();
  for_each_particle(members.size(), [&](std::size_t member) {
    const std::uint32_t i = members[member];
    const MotionRecord& own = all[i];
    Lane cx = 0, cy = 0, cz = 0;
    for (std::size_t k = list.first[i]; k < list.last[i]; k += lane_count) {
      const std::uint32_t* j = &list.index[k];
      const Lane dx = own.x - gather(all, j, &MotionRecord::x);
      const Lane dy = own.y - gather(all, j, &MotionRecord::y);
      const Lane dz = own.z - gather(all, j, &MotionRecord::z);
      const Lane r = square_root(larger(dx * dx + dy * dy + dz * dz, Lane(1e-40)));
      const Lane weight = gather(all, j, &MotionRecord::volume) * kernel_.slope(r) / r;
      cx += weight * dx;
      cy += weight * dy;
      cz += weight * dz;
    }
    colour_[i] = {sum_lanes(cx), sum_lanes(cy), sum_lanes(cz)};
  });
}

void FreeSurfaceFlow::write_surface(const Particles& particles, const std::vector<Ghost>& ghosts,
                                    const MeltProperties& properties) {
  const auto write = [&](std::uint32_t i) {
    const Vector &at = particles.position[i], &c = colour_[i];
    const double size = std::sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
    const double strength = size * kernel_.smoothing_length;
    SurfaceRecord& record = surface_[i];
    record = {at[0], at[1], at[2], 0, 0, 0, properties.surface_tension[i], 0};
    normal_[i] = {};
    if (strength >= interface_threshold) {
      // The colour gradient points into the metal.
      normal_[i] = {-c[0] / size, -c[1] / size, -c[2] / size};
      record.nx = normal_[i][0];
      record.ny = normal_[i][1];
      record.nz = normal_[i][2];
      record.strength = strength;
    }
  };
  for_each_particle(liquid_.size(), [&](std::size_t k) { write(liquid_[k]); });
  for_each_particle(wall_.size(), [&](std::size_t k) { write(wall_[k]); });
  const std::size_t n = particles.size();
  for (const std::uint32_t g : near_ghosts_) {
    const std::uint32_t source = ghosts[g].source;
    const Vector at = ghosts[g].image_of(particles.position[source]);
    const Vector normal = ghosts[g].mirrored(normal_[source]);
    surface_[n + g] = {at[0],
                       at[1],
                       at[2],
                       normal[0],
                       normal[1],
                       normal[2],
                       surface_[source].tension,
                       surface_[source].strength};
  }
}

void FreeSurfaceFlow::set_properties(const Particles& particles, const std::vector<Ghost>& ghosts,
                                     const NeighbourList& list, const MeltProperties& properties) {
  write_motion(particles, ghosts);
  // Walls stand still and melt moves little between two calls, so their normals are kept until the
  // next one.
  colour_gradients(list, wall_);
  colour_gradients(list, liquid_);
  if (settings_.density_diffusion > 0 && settings_.diffusion_form == DensityDiffusion::corrected) {
    density_gradients(particles, ghosts, list);
  }
  if (!settings_.marangoni) {
    return;
  }
  write_surface(particles, ghosts, properties);
  const SurfaceRecord* all = surface_.data();
  for_each_particle(liquid_.size(), [&](std::size_t member) {
    const std::uint32_t i = liquid_[member];
    const SurfaceRecord& own = all[i];
    tension_gradient_[i] = {};
    if (own.strength <= 0) {
      return;
    }
    Lane bx = 0, by = 0, bz = 0, xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
    for (std::size_t k = list.first[i]; k < list.last[i]; k += lane_count) {
      const std::uint32_t* j = &list.index[k];
      const Lane dx = own.x - gather(all, j, &SurfaceRecord::x);
      const Lane dy = own.y - gather(all, j, &SurfaceRecord::y);
      const Lane dz = own.z - gather(all, j, &SurfaceRecord::z);
      const Lane r2 = dx * dx + dy * dy + dz * dz;
      const Lane r = square_root(larger(r2, Lane(1e-40)));
      const Lane factor = r * kernel_.slope(r) / (r2 + kernel_.regularisation);
      const Lane change = factor * (own.tension - gather(all, j, &SurfaceRecord::tension));
      bx += change * dx;
      by += change * dy;
      bz += change * dz;
      xx += factor * dx * dx;
      yy += factor * dy * dy;
      zz += factor * dz * dz;
      xy += factor * dx * dy;
      xz += factor * dx * dz;
      yz += factor * dy * dz;
    }
    InterfaceSums sums;
    sums.difference = {sum_lanes(bx), sum_lanes(by), sum_lanes(bz)};
    sums.moment = {sum_lanes(xx), sum_lanes(yy), sum_lanes(zz),
                   sum_lanes(xy), sum_lanes(xz), sum_lanes(yz)};
    tension_gradient_[i] = surface_gradient(sums, normal_[i]);
  });
}

void FreeSurfaceFlow::curvatures(const NeighbourList& list) {
  const SurfaceRecord* all = surface_.data();
  for_each_particle(liquid_.size(), [&](std::size_t member) {
    const std::uint32_t i = liquid_[member];
    const SurfaceRecord& own = all[i];
    area_[i] = curvature_[i] = 0;
    limited_[i] = 0;
    if (own.strength <= 0) {
      return;
    }
    Lane turn = 0, reach = 0, strongest = own.strength;
    for (std::size_t k = list.first[i]; k < list.last[i]; k += lane_count) {
      const std::uint32_t* j = &list.index[k];
      const Lane strength = gather(all, j, &SurfaceRecord::strength);
      const Lane dx = own.x - gather(all, j, &SurfaceRecord::x);
      const Lane dy = own.y - gather(all, j, &SurfaceRecord::y);
      const Lane dz = own.z - gather(all, j, &SurfaceRecord::z);
      const Lane r2 = dx * dx + dy * dy + dz * dz;
      const Lane r = square_root(larger(r2, Lane(1e-40)));
      const Lane plain = r * kernel_.slope(r) / (r2 + kernel_.regularisation);
      const Lane factor = where_positive(strength, plain, Lane(0.0));
      // Within the list's skin, but out of the kernel's support, nobody counts.
      strongest = larger(strongest, where_positive(-factor, strength, Lane(0.0)));
      const Lane across = dx * own.nx + dy * own.ny + dz * own.nz;
      const Lane tx = dx - across * own.nx, ty = dy - across * own.ny, tz = dz - across * own.nz;
      turn += factor * ((own.nx - gather(all, j, &SurfaceRecord::nx)) * tx +
                        (own.ny - gather(all, j, &SurfaceRecord::ny)) * ty +
                        (own.nz - gather(all, j, &SurfaceRecord::nz)) * tz);
      reach += factor * (tx * tx + ty * ty + tz * tz);
    }
    double most = 0;
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      most = std::max(most, static_cast<double>(strongest[lane]));
    }
    if (most < outermost_threshold) {
      normal_[i] = {};
      return;
    }
    InterfaceSums sums;
    sums.turn = sum_lanes(turn);
    sums.reach = sum_lanes(reach);
    bool limited = false;
    const double depth = surface_depth(own.strength) * kernel_.smoothing_length;
    curvature_[i] = surface_curvature(sums, dimensions_, depth, spacing_, limited);
    limited_[i] = limited ? 1 : 0;
    area_[i] = 2 * own.strength / kernel_.smoothing_length * motion_[i].volume;
  });
}

void FreeSurfaceFlow::walls(const std::vector<Ghost>& ghosts) {
  const ForceRecord* all = force_.data();
  const std::size_t n = role_.size();
  for_each_particle(wall_.size(), [&](std::size_t member) {
    const std::uint32_t i = wall_[member];
    const ForceRecord& own = all[i];
    WallSums<Lane> sums;
    for (std::size_t k = melt_near_wall_.first[member]; k < melt_near_wall_.last[member];
         k += lane_count) {
      const std::uint32_t* j = &melt_near_wall_.index[k];
      const Lane density = gather(all, j, &ForceRecord::density);
      const Lane dx = own.x - gather(all, j, &ForceRecord::x);
      const Lane dy = own.y - gather(all, j, &ForceRecord::y);
      const Lane dz = own.z - gather(all, j, &ForceRecord::z);
      const Lane w = where_positive(
          density, kernel_.value(square_root(dx * dx + dy * dy + dz * dz)), Lane(0.0));
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
  });
  for (const std::uint32_t g : near_ghosts_) {
    if (role_[ghosts[g].source] == 2) {
      const ForceRecord& source = force_[ghosts[g].source];
      const Vector v = ghosts[g].mirrored({source.vx, source.vy, source.vz});
      ForceRecord& image = force_[n + g];
      image.pressure = source.pressure;
      image.vx = v[0];
      image.vy = v[1];
      image.vz = v[2];
    }
  }
}

void FreeSurfaceFlow::forces(const Particles& particles, const NeighbourList& list,
                             const MeltProperties& properties) {
  const ForceRecord* all = force_.data();
  const QuinticSpline half(kernel_.smoothing_length / 2, dimensions_);
  const bool repel = settings_.cure == ClumpingCure::repulsion && settings_.repulsion > 0;
  const bool transport = settings_.cure == ClumpingCure::transport;
  const double artificial =
      settings_.artificial_viscosity * settings_.sound_speed * kernel_.smoothing_length / 2;
  for_each_particle(liquid_.size(), [&](std::size_t member) {
    const std::uint32_t i = liquid_[member];
    const ForceRecord& own = all[i];
    Lane ax = 0, ay = 0, az = 0, sx = 0, sy = 0, sz = 0;
    const Lane own_square = own.volume * own.volume;
    for (std::size_t k = list.first[i]; k < list.last[i]; k += lane_count) {
      const std::uint32_t* j = &list.index[k];
      const Lane dx = own.x - gather(all, j, &ForceRecord::x);
      const Lane dy = own.y - gather(all, j, &ForceRecord::y);
      const Lane dz = own.z - gather(all, j, &ForceRecord::z);
      const Lane ux = own.vx - gather(all, j, &ForceRecord::vx);
      const Lane uy = own.vy - gather(all, j, &ForceRecord::vy);
      const Lane uz = own.vz - gather(all, j, &ForceRecord::vz);
      const Lane volume = gather(all, j, &ForceRecord::volume);
      const Lane other = gather(all, j, &ForceRecord::density);
      // Walls take the fluid's density and viscosity in the pair.
      const Lane density = where_positive(other, other, Lane(own.density));
      const Lane viscosity =
          where_positive(other, gather(all, j, &ForceRecord::viscosity), Lane(own.viscosity));
      const Lane r2 = dx * dx + dy * dy + dz * dz;
      const Lane r = square_root(larger(r2, Lane(1e-40)));
      const Lane weight = (own_square + volume * volume) * kernel_.slope(r) / r;
      Lane pressure = pressure_pair(Lane(own.pressure), Lane(own.density),
                                    gather(all, j, &ForceRecord::pressure), density);
      if (repel) {
        pressure +=
            repulsion_pair(kernel_.value(r) * (1 / kernel_at_spacing_), settings_.repulsion);
      }
      const Lane softened = r2 / (r2 + kernel_.regularisation);
      if (artificial > 0) {
        const Lane approach = positive_part(-(dx * ux + dy * uy + dz * uz));
        pressure += artificial * own.density * approach / (r2 + kernel_.regularisation);
      }
      const Lane normal = weight * pressure;
      const Lane shear = weight * softened * viscosity_pair(Lane(own.viscosity), viscosity);
      ax += shear * ux - normal * dx;
      ay += shear * uy - normal * dy;
      az += shear * uz - normal * dz;
      if (transport) {
        const Lane push = (own_square + volume * volume) * half.slope(r) / r;
        sx += push * dx;
        sy += push * dy;
        sz += push * dz;
      }
    }
    const double mass = particles.mass[i];
    Vector& a = acceleration_[i];
    a = {sum_lanes(ax) / mass, sum_lanes(ay) / mass, sum_lanes(az) / mass};
    if (transport) {
      const double background = std::min(10 * std::abs(own.pressure), settings_.transport_pressure);
      shift_[i] = {-background * sum_lanes(sx) / mass, -background * sum_lanes(sy) / mass,
                   -background * sum_lanes(sz) / mass};
    }
    double inward = 0;
    if (settings_.surface_tension) {
      inward += properties.surface_tension[i] * curvature_[i];
    }
    if (settings_.recoil) {
      inward += properties.recoil[i];
    }
    const double area_over_mass = area_[i] / mass;
    for (std::size_t d = 0; d < 3; ++d) {
      a[d] += settings_.gravity[d] - area_over_mass * inward * normal_[i][d];
      if (settings_.marangoni && area_[i] > 0) {
        a[d] += area_over_mass * tension_gradient_[i][d];
      }
    }
  });
}

void FreeSurfaceFlow::evaluate(const Particles& particles, const std::vector<Ghost>& ghosts,
                               const NeighbourList& list, const MeltProperties& properties) {
  write_surface(particles, ghosts, properties);
  curvatures(list);
  const std::size_t n = particles.size();
  const double stiffness = settings_.sound_speed * settings_.sound_speed;
  for_each_particle(liquid_.size(), [&](std::size_t k) {
    const std::uint32_t i = liquid_[k];
    const double density = particles.density[i];
    const double reference = particles.mass[i] / particles.volume[i];
    pressure_[i] = state_pressure(density, reference, stiffness * reference, 0);
    const Vector &at = particles.position[i], &v = particles.velocity[i];
    force_[i] = {at[0],
                 at[1],
                 at[2],
                 v[0],
                 v[1],
                 v[2],
                 particles.mass[i] / density,
                 pressure_[i],
                 density,
                 properties.viscosity[i]};
  });
  for (const std::uint32_t g : near_ghosts_) {
    const std::uint32_t source = ghosts[g].source;
    if (role_[source] == 1) {
      const Vector at = ghosts[g].image_of(particles.position[source]);
      const Vector v = ghosts[g].mirrored(particles.velocity[source]);
      force_[n + g] = force_[source];
      force_[n + g].x = at[0];
      force_[n + g].y = at[1];
      force_[n + g].z = at[2];
      force_[n + g].vx = v[0];
      force_[n + g].vy = v[1];
      force_[n + g].vz = v[2];
    }
  }
  walls(ghosts);
  forces(particles, list, properties);
}

void FreeSurfaceFlow::finish(Particles& particles, const std::vector<Ghost>& ghosts,
                             const NeighbourList& list, const MeltProperties& properties,
                             double dt) {
  write_motion(particles, ghosts);
  densities(particles, list, dt);
  evaluate(particles, ghosts, list, properties);
  for_each_particle(liquid_.size(), [&](std::size_t k) {
    const std::uint32_t i = liquid_[k];
    for (std::size_t d = 0; d < 3; ++d) {
      particles.velocity[i][d] += dt / 2 * acceleration_[i][d];
      shift_[i][d] *= dt;
    }
  });
  limiters_.particle_steps += liquid_.size();
  limiters_.wall_steps += wall_.size();
  for (const std::uint32_t i : liquid_) {
    limiters_.curvature += limited_[i];
  }
  for (const std::uint32_t i : wall_) {
    limiters_.wall_pressure += limited_[i];
  }
}

std::string FreeSurfaceFlow::diagnose(const Particles& particles, std::uint32_t i,
                                      const MeltProperties& properties) const {
  const auto bad = [](const Vector& v) { return !std::isfinite(v[0] + v[1] + v[2]); };
  if (!std::isfinite(particles.density[i])) {
    return fmt::format("the continuity term (density {})", particles.density[i]);
  }
  if (bad(colour_[i])) {
    return "the colour gradient";
  }
  if (!std::isfinite(curvature_[i])) {
    return "the curvature of the surface";
  }
  if (!std::isfinite(properties.surface_tension[i]) || bad(tension_gradient_[i])) {
    return "the gradient of the surface tension (Marangoni force)";
  }
  if (!std::isfinite(properties.recoil[i])) {
    return "the recoil pressure";
  }
  if (!std::isfinite(properties.viscosity[i])) {
    return "the viscosity";
  }
  return fmt::format("the pressure and viscous forces (pressure {:.4g} Pa, density {:.4g} kg/m3)",
                     pressure_[i], particles.density[i]);
}

}  // namespace meltproof::solver

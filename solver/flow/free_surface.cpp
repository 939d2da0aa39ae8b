// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flow/free_surface.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace meltproof::solver {

FreeSurfaceFlow::FreeSurfaceFlow(const FlowSettings& settings, const QuinticSpline& kernel,
                                 double spacing, int dimensions, Halo& halo)
    : settings_(settings),
      kernel_(kernel),
      spacing_(spacing),
      dimensions_(dimensions),
      halo_(halo),
      depth_(dimensions),
      outermost_depth_(depth_(outermost_threshold)) {
  const auto reach = static_cast<int>(std::ceil(kernel.support() / spacing));
  lattice_sum_ = 0;
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) {
      for (int k = dimensions == 3 ? -reach : 0; k <= (dimensions == 3 ? reach : 0); ++k) {
        lattice_sum_ += kernel.value(spacing * std::sqrt(i * i + j * j + k * k));
      }
    }
  }
  alone_ = kernel.value(0.0) / lattice_sum_;
  lattice_sum_ *= std::pow(spacing, dimensions);
}

void FreeSurfaceFlow::kick_and_drift(Particles& particles, double dt) {
  for_each_particle(liquid_.size(), [&](std::size_t k) {
    const std::uint32_t i = liquid_[k], s = liquid_slot_[k];
    for (std::size_t d = 0; d < 3; ++d) {
      particles.velocity[i][d] += dt / 2 * acceleration_[s][d];
      particles.position[i][d] += dt * (particles.velocity[i][d] + dt * shift_[s][d]);
    }
  });
}

void FreeSurfaceFlow::follow(Particles& particles) {
  halo_.exchange(
      Halo::liquid, 6,
      [&](std::uint32_t i, double* out) {
        std::copy_n(particles.position[i].begin(), 3, out);
        std::copy_n(particles.velocity[i].begin(), 3, out + 3);
      },
      [&](std::uint32_t i, const double* in) {
        std::copy_n(in, 3, particles.position[i].begin());
        std::copy_n(in + 3, 3, particles.velocity[i].begin());
      });
}

FlowParticle FreeSurfaceFlow::particle(std::uint32_t i) const {
  const std::uint32_t s = i < slot_.size() ? slot_[i] : nowhere;
  if (s == nowhere) {
    return {};
  }
  const DensityRecord& gradient = density_gradient_[s];
  return {colour_[s],
          {gradient.x, gradient.y, gradient.z},
          tension_gradient_[s],
          acceleration_[s],
          shift_[s],
          exposed_[s],
          pressure_[s],
          melt_[s]};
}

void FreeSurfaceFlow::evaluate(const Particles& particles, const std::vector<Ghost>& ghosts) {
  write_surface(particles, ghosts);
  curvatures(ghosts);
  const double stiffness = settings_.sound_speed * settings_.sound_speed;
  const auto write = [&](std::uint32_t i) {
    const std::uint32_t s = slot_[i];
    const double density = particles.density[i];
    const double reference = particles.mass[i] / particles.volume[i];
    pressure_[s] = state_pressure(density, reference, stiffness * reference, 0);
    const Vector &at = particles.position[i], &v = particles.velocity[i];
    force_[s] = {at[0],
                 at[1],
                 at[2],
                 v[0],
                 v[1],
                 v[2],
                 particles.mass[i] / density,
                 pressure_[s],
                 density,
                 melt_[s].viscosity};
  };
  for_each_particle(liquid_.size(), [&](std::size_t k) { write(liquid_[k]); });
  for_each_particle(liquid_copies_.size(), [&](std::size_t k) { write(liquid_copies_[k]); });
  for_each_image(ghosts, [&](std::uint32_t s, const Ghost& ghost, std::uint32_t source) {
    if (role_[ghost.source] == 1) {
      const Vector at = ghost.image_of(particles.position[ghost.source]);
      const Vector v = ghost.mirrored(particles.velocity[ghost.source]);
      ForceRecord& image = force_[s] = force_[source];
      image.x = at[0];
      image.y = at[1];
      image.z = at[2];
      image.vx = v[0];
      image.vy = v[1];
      image.vz = v[2];
    }
  });
  walls_and_missing_gradients(ghosts);
  forces(particles);
}

void FreeSurfaceFlow::finish(Particles& particles, const std::vector<Ghost>& ghosts, double dt) {
  write_motion(particles, ghosts);
  find_near();
  densities(particles, dt);
  evaluate(particles, ghosts);
  for_each_particle(liquid_.size(), [&](std::size_t k) {
    const std::uint32_t i = liquid_[k], s = liquid_slot_[k];
    for (std::size_t d = 0; d < 3; ++d) {
      particles.velocity[i][d] += dt / 2 * acceleration_[s][d];
    }
  });
  limiters_.particle_steps += liquid_.size();
  limiters_.wall_steps += wall_.size();
  for (const std::uint32_t i : liquid_slot_) {
    limiters_.curvature += limited_[i];
  }
  for (const std::uint32_t i : wall_slot_) {
    limiters_.wall_pressure += limited_[i];
  }
}

FlowMemory FreeSurfaceFlow::memory() const {
  FlowMemory memory;
  for (const std::uint32_t i : liquid_slot_) {
    memory.acceleration.push_back(acceleration_[i]);
    memory.shift.push_back(shift_[i]);
    memory.area.push_back(exposed_[i]);
    memory.pressure.push_back(pressure_[i]);
    memory.viscosity.push_back(melt_[i].viscosity);
    memory.surface_tension.push_back(melt_[i].surface_tension);
    memory.recoil.push_back(melt_[i].recoil);
  }
  return memory;
}

void FreeSurfaceFlow::remember(const FlowMemory& memory, const LimiterCounts& limiters) {
  for (std::size_t k = 0; k < liquid_slot_.size(); ++k) {
    const std::uint32_t i = liquid_slot_[k];
    acceleration_[i] = memory.acceleration[k];
    shift_[i] = memory.shift[k];
    exposed_[i] = memory.area[k];
    pressure_[i] = memory.pressure[k];
    melt_[i] = {memory.viscosity[k], memory.surface_tension[k], memory.recoil[k]};
  }
  limiters_ = limiters;
}

std::string FreeSurfaceFlow::diagnose(const Particles& particles, std::uint32_t i) const {
  const auto bad = [](const Vector& v) { return !std::isfinite(v[0] + v[1] + v[2]); };
  if (!std::isfinite(particles.density[i])) {
    return fmt::format("the continuity term (density {})", particles.density[i]);
  }
  const std::uint32_t s = slot_[i];
  if (bad(colour_[s])) {
    return "the colour gradient";
  }
  if (!std::isfinite(curvature_[s])) {
    return "the curvature of the surface";
  }
  if (!std::isfinite(melt_[s].surface_tension) || bad(tension_gradient_[s])) {
    return "the gradient of the surface tension (Marangoni force)";
  }
  if (!std::isfinite(melt_[s].recoil)) {
    return "the recoil pressure";
  }
  if (!std::isfinite(melt_[s].viscosity)) {
    return "the viscosity";
  }
  const double shifted = std::hypot(shift_[s][0], shift_[s][1], shift_[s][2]);
  const Vector& v = particles.velocity[i];
  if (!(shifted <= std::hypot(v[0], v[1], v[2]))) {
    return fmt::format("the transport velocity, {:.4g} m/s", shifted);
  }
  return fmt::format("the pressure and viscous forces (pressure {:.4g} Pa, density {:.4g} kg/m3)",
                     pressure_[s], particles.density[i]);
}

}  // namespace meltproof::solver

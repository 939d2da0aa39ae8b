// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flow/free_surface.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "solver/particles/loops.hpp"

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
    const std::uint32_t i = liquid_[k];
    for (std::size_t d = 0; d < 3; ++d) {
      particles.velocity[i][d] += dt / 2 * acceleration_[i][d];
      particles.position[i][d] += dt * (particles.velocity[i][d] + dt * shift_[i][d]);
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
  const DensityRecord& gradient = density_gradient_[i];
  return {colour_[i],
          {gradient.x, gradient.y, gradient.z},
          tension_gradient_[i],
          acceleration_[i],
          shift_[i],
          exposed_[i],
          pressure_[i]};
}

void FreeSurfaceFlow::set_particle(std::uint32_t i, const FlowParticle& what) {
  colour_[i] = what.colour;
  const Vector& gradient = what.density_gradient;
  density_gradient_[i] = {gradient[0], gradient[1], gradient[2]};
  tension_gradient_[i] = what.tension_gradient;
  acceleration_[i] = what.acceleration;
  shift_[i] = what.shift;
  exposed_[i] = what.exposed;
  pressure_[i] = what.pressure;
}

void FreeSurfaceFlow::evaluate(const Particles& particles, const std::vector<Ghost>& ghosts,
                               const NeighbourList& list, const MeltProperties& properties) {
  write_surface(particles, ghosts, list, properties);
  curvatures(ghosts, list);
  const std::size_t n = particles.size();
  const double stiffness = settings_.sound_speed * settings_.sound_speed;
  const auto write = [&](std::uint32_t i) {
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
  };
  for_each_particle(liquid_.size(), [&](std::size_t k) { write(liquid_[k]); });
  for_each_particle(liquid_copies_.size(), [&](std::size_t k) { write(liquid_copies_[k]); });
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
  missing_gradients(list);
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

FlowMemory FreeSurfaceFlow::memory() const {
  FlowMemory memory;
  for (const std::uint32_t i : liquid_) {
    memory.acceleration.push_back(acceleration_[i]);
    memory.shift.push_back(shift_[i]);
    memory.area.push_back(exposed_[i]);
    memory.pressure.push_back(pressure_[i]);
  }
  return memory;
}

void FreeSurfaceFlow::remember(const FlowMemory& memory, const LimiterCounts& limiters) {
  for (std::size_t k = 0; k < liquid_.size(); ++k) {
    const std::uint32_t i = liquid_[k];
    acceleration_[i] = memory.acceleration[k];
    shift_[i] = memory.shift[k];
    exposed_[i] = memory.area[k];
    pressure_[i] = memory.pressure[k];
  }
  limiters_ = limiters;
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
  const double shifted = std::hypot(shift_[i][0], shift_[i][1], shift_[i][2]);
  const Vector& v = particles.velocity[i];
  if (!(shifted <= std::hypot(v[0], v[1], v[2]))) {
    return fmt::format("the transport velocity, {:.4g} m/s", shifted);
  }
  return fmt::format("the pressure and viscous forces (pressure {:.4g} Pa, density {:.4g} kg/m3)",
                     pressure_[i], particles.density[i]);
}

}  // namespace meltproof::solver

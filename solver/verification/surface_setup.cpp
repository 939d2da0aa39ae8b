// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/verification/surface_setup.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"
#include "solver/particles/cell_grid.hpp"
#include "solver/verification/setup.hpp"

namespace meltproof::solver {

Mixture melt_and_wall(const VerificationCase& c) {
  const double conductivity = c.diffusivity * c.density * PlainMatter::specific_heat;
  Material melt = plain_material("melt", conductivity, 1, 2);
  melt.density = c.density;
  melt.viscosity = constant_property(c.viscosity, "Pa s");
  melt.surface_tension =
      constant_property(c.surface_tension - c.surface_tension_slope * c.temperature, "N m-1");
  melt.surface_tension.pieces.front().linear = c.surface_tension_slope;
  Material wall = melt;
  wall.name = "wall";
  wall.solidus = 1e5;
  wall.liquidus = 2e5;
  return {melt, wall};
}

Particles fill_cells(const VerificationCase& c, double spacing, const Mixture& mixture,
                     const std::array<std::int64_t, 3>& first,
                     const std::array<std::int64_t, 3>& last,
                     const std::function<Fill(const Vector&)>& fill) {
  Particles particles;
  particles.dimensions = static_cast<int>(c.dimensions);
  particles.spacing = spacing;
  const bool flat = c.dimensions == 2;
  const double volume = std::pow(spacing, particles.dimensions);
  const auto centre = [spacing](std::int64_t i) {
    return (static_cast<double>(i) + 0.5) * spacing;
  };
  for (std::int64_t k = flat ? 0 : first[2]; k < (flat ? 1 : last[2]); ++k) {
    for (std::int64_t j = first[1]; j < last[1]; ++j) {
      for (std::int64_t i = first[0]; i < last[0]; ++i) {
        const Vector at{centre(i), centre(j), flat ? 0 : centre(k)};
        const Fill kind = fill(at);
        if (kind != Fill::nothing) {
          const double concentration = kind == Fill::wall ? 1 : 0;
          particles.add(static_cast<std::int64_t>(particles.size()), at, c.density * volume, volume,
                        mixture.enthalpy(c.temperature, concentration), concentration,
                        Origin::plate);
        }
      }
    }
  }
  return particles;
}

Model surface_model(const VerificationCase& c) {
  if (c.sound_speed <= 0) {
    throw InputError(
        fmt::format("{}: sound_speed is missing: a free surface needs one that holds "
                    "the pressures that act, for instance 50 m/s",
                    c.name));
  }
  Model model;
  model.conduction = false;
  model.species = false;
  FlowSettings flow;
  flow.sound_speed = c.sound_speed;
  flow.viscosity_factor = 1;
  flow.recoil = false;
  flow.gravity = {0, 0, 0};
  flow.gravity[c.dimensions == 2 ? 1 : 2] = -c.gravity;
  flow.cure = c.variant == "none"        ? ClumpingCure::none
              : c.variant == "transport" ? ClumpingCure::transport
                                         : ClumpingCure::repulsion;
  flow.diffusion_form =
      c.variant == "plain" ? DensityDiffusion::plain : DensityDiffusion::corrected;
  model.flow = flow;
  return model;
}

void start_moving(Engine& engine, const std::function<double(const Vector&)>& pressure,
                  const std::function<Vector(const Vector&)>& velocity) {
  const Particles& particles = engine.particles();
  const double c = engine.flow().settings().sound_speed;
  std::vector<double> density(particles.size());
  std::vector<Vector> start(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const auto id = static_cast<std::size_t>(particles.identity[i]);
    const bool melt = particles.phase[i] == Phase::liquid;
    density[id] = particles.mass[i] / particles.volume[i] +
                  (melt ? pressure(particles.position[i]) / (c * c) : 0);
    start[id] = melt ? velocity(particles.position[i]) : Vector{};
  }
  engine.set_state(start, density);
}

void start_at_rest(Engine& engine, const std::function<double(const Vector&)>& pressure) {
  start_moving(engine, pressure, [](const Vector&) { return Vector{}; });
}

MeltMotion melt_motion(const Engine& engine) {
  const Particles& particles = engine.particles();
  const PackedLists& list = engine.neighbours();
  const double near = particles.spacing * particles.spacing / 4;
  MeltMotion state;
  double mass = 0;
  std::size_t clumped = 0;
  for (const std::uint32_t i : engine.flow().liquid()) {
    const Vector &v = particles.velocity[i], &at = particles.position[i];
    const double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    state.kinetic_energy += particles.mass[i] * square / 2;
    state.fastest = std::max(state.fastest, std::sqrt(square));
    mass += particles.mass[i];
    const bool close = list.any(i, [&](std::uint32_t j) {
      return j < particles.size() && squared_distance(at, particles.position[j]) < near;
    });
    clumped += close ? 1 : 0;
  }
  if (mass > 0) {
    state.root_mean_square = std::sqrt(2 * state.kinetic_energy / mass);
    state.clumped =
        static_cast<double>(clumped) / static_cast<double>(engine.flow().liquid().size());
  }
  return state;
}

MeanPressure mean_pressure(const Engine& engine, const std::function<bool(const Vector&)>& where) {
  const Particles& particles = engine.particles();
  const QuinticSpline& kernel = engine.kernel();
  const FlowSettings& settings = engine.flow().settings();
  const double strength = settings.cure == ClumpingCure::repulsion ? settings.repulsion : 0;
  const double onset = kernel.value(settings.repulsion_distance * particles.spacing);
  const auto ghosts = make_ghosts(particles, engine.model().domain, kernel.support());
  const NeighbourList list = make_neighbours(particles, ghosts, kernel.support());
  const std::size_t n = particles.size();
  MeanPressure mean;
  double volume = 0;
  for (const std::uint32_t i : engine.flow().liquid()) {
    const Vector& at = particles.position[i];
    if (!where(at)) {
      continue;
    }
    const double own = particles.mass[i] / particles.density[i];
    volume += own;
    mean.state += own * engine.flow().pressure(i);
    double virial = 0;
    for (std::size_t k = list.first[i]; k < list.last[i] && strength > 0; ++k) {
      const std::uint32_t j = list.index[k];
      if (j == list.void_index) {
        continue;
      }
      const std::uint32_t source = j < n ? j : ghosts[j - n].source;
      const Vector& other = j < n ? particles.position[j] : ghosts[j - n].position;
      const double x = at[0] - other[0], y = at[1] - other[1], z = at[2] - other[2];
      const double r = std::sqrt(x * x + y * y + z * z);
      const double its = particles.mass[source] / particles.density[source];
      virial += (own * own + its * its) * repulsion_pair(kernel.value(r) / onset, strength) * r *
                kernel.slope(r);
    }
    mean.repulsion -= virial / (2 * particles.dimensions);
  }
  mean.state /= volume;
  mean.repulsion /= volume;
  return mean;
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/multiphase/closed_flow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include "base/error.hpp"
#include "solver/particles/loops.hpp"

namespace meltproof::solver {
namespace {

/// How many rebuilds of the lists pass before the particles are put in space-filling order again.
constexpr std::size_t builds_per_sort = 50;

template <class T>
void permute(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
  std::vector<T> sorted(values.size());
  std::transform(order.begin(), order.end(), sorted.begin(),
                 [&](std::uint32_t i) { return values[i]; });
  values = std::move(sorted);
}

std::vector<std::uint32_t> by_identity(const Particles& particles) {
  std::vector<std::uint32_t> order(particles.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return particles.identity[a] < particles.identity[b];
  });
  return order;
}

/// sort_in_space(), and for every new place the old one.
std::vector<std::uint32_t> sort_and_track(Particles& particles, double cell) {
  const auto before = by_identity(particles);
  sort_in_space(particles, cell);
  const auto after = by_identity(particles);
  std::vector<std::uint32_t> from(particles.size());
  for (std::size_t k = 0; k < before.size(); ++k) {
    from[after[k]] = before[k];
  }
  return from;
}

void check(const Particles& particles, const std::vector<std::int32_t>& fluid,
           const ClosedFlowModel& model) {
  if (!(model.stiffness > 0) || !(particles.spacing > 0)) {
    throw InputError(
        fmt::format("closed flow: stiffness {} Pa and spacing {} m: expected both to be positive",
                    model.stiffness, particles.spacing));
  }
  if (fluid.size() != particles.size()) {
    throw InputError(fmt::format("closed flow: {} entries say which fluid, for {} particles",
                                 fluid.size(), particles.size()));
  }
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    const bool wall = particles.phase[i] == Phase::solid;
    if (!wall && (fluid[i] < 0 || fluid[i] >= static_cast<std::int32_t>(model.fluids.size()))) {
      throw InputError(
          fmt::format("closed flow: particle {} is of fluid {}, but there are fluids 0 to {} only",
                      particles.identity[i], fluid[i], static_cast<int>(model.fluids.size()) - 1));
    }
  }
}

}  // namespace

ClosedFlow::ClosedFlow(Particles particles, std::vector<std::int32_t> fluid, ClosedFlowModel model)
    : particles_(std::move(particles)),
      model_(std::move(model)),
      kernel_(model_.smoothing_length > 0 ? model_.smoothing_length : particles_.spacing,
              particles_.dimensions),
      depth_(kernel_, particles_.dimensions) {
  check(particles_, fluid, model_);
  // Friction and heat are exact for a parabola on the undisturbed lattice.
  set_lattice_moments(kernel_, particles_.spacing, particles_.dimensions, LatticeMoments::second);
  const std::size_t n = particles_.size();
  fields_.fluid = std::move(fluid);
  fields_.viscosity.assign(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    if (is_fluid(i)) {
      fields_.viscosity[i] = model_.fluids[static_cast<std::size_t>(fields_.fluid[i])].viscosity;
    }
  }
  fields_.tension.assign(n, 0);
  fields_.recoil.assign(n, 0);
  fields_.wall_acceleration.assign(n, {});
  acceleration_.assign(n, {});
  background_.assign(n, {});
  transport_.assign(n, {});
  surface_force_.assign(n, {});
  normal_.assign(n, {});
  pressure_.assign(n, 0);
  curvature_.assign(n, 0);
  heating_.assign(n, 0);
  interface_depth_.assign(n, 0);
  build_lists();
  evaluate();
}

void ClosedFlow::build_lists() {
  const std::size_t n = particles_.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t d = 0; d < 3; ++d) {
      const double lower = model_.domain.lower[d], upper = model_.domain.upper[d];
      if (model_.domain.face[d][0] == Face::periodic) {
        double& x = particles_.position[i][d];
        x -= (upper - lower) * std::floor((x - lower) / (upper - lower));
        // Rounding can put a particle just below the lower face onto the upper one.
        x = x < upper ? x : lower;
      }
    }
  }
  if (builds_ % builds_per_sort == 0) {
    const auto from = sort_and_track(particles_, kernel_.support());
    permute(fields_.fluid, from);
    permute(fields_.viscosity, from);
    permute(fields_.tension, from);
    permute(fields_.recoil, from);
    permute(fields_.wall_acceleration, from);
    permute(acceleration_, from);
    permute(background_, from);
    permute(transport_, from);
    permute(heating_, from);
    permute(pressure_, from);
  }
  ++builds_;
  const double reach = kernel_.support() + model_.skin * kernel_.smoothing_length;
  ghosts_ = make_ghosts(particles_, model_.domain, reach);
  neighbours_ = make_neighbours(particles_, ghosts_, reach);
  built_at_ = particles_.position;
  records_.assign(n + ghosts_.size() + 1, FlowRecord());
  // The void takes part in nothing, but pairs divide by its density.
  records_.back().density = 1;
  heat_.assign(model_.heat ? n + ghosts_.size() + 1 : 0, ConductionRecord());
  surface_.assign(model_.interface ? n + ghosts_.size() + 1 : 0, InterfaceRecord());
}

void ClosedFlow::stop() {
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    if (is_fluid(i)) {
      particles_.velocity[i] = {};
      transport_[i] = {};
    }
  }
  evaluate();
}

void ClosedFlow::kick(double dt) {
  for_each_particle(particles_.size(), [&](std::size_t i) {
    if (!is_fluid(i)) {
      return;
    }
    for (std::size_t d = 0; d < 3; ++d) {
      particles_.velocity[i][d] += dt * acceleration_[i][d];
      transport_[i][d] = dt * background_[i][d];
    }
    if (model_.heat) {
      particles_.temperature[i] += dt * heating_[i];
    }
  });
}

void ClosedFlow::move(double dt) {
  for_each_particle(particles_.size(), [&](std::size_t i) {
    if (is_fluid(i)) {
      for (std::size_t d = 0; d < 3; ++d) {
        particles_.position[i][d] += dt * (particles_.velocity[i][d] + transport_[i][d]);
      }
    }
  });
  const double farthest = block_max(particles_.size(), 0, [&](std::size_t i) {
    double squared = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      const double moved = particles_.position[i][d] - built_at_[i][d];
      squared += moved * moved;
    }
    return std::isfinite(squared) ? squared : std::numeric_limits<double>::infinity();
  });
  if (!std::isfinite(farthest)) {
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      const Vector& at = particles_.position[i];
      if (!std::isfinite(at[0] + at[1] + at[2])) {
        throw std::runtime_error(fmt::format(
            "closed flow: the velocity of particle {} is no number after {} steps at t = {:.6g} s; "
            "last seen at ({:.6g}, {:.6g}, {:.6g}) m",
            particles_.identity[i], steps_, time_, built_at_[i][0], built_at_[i][1],
            built_at_[i][2]));
      }
    }
  }
  const double skin = model_.skin * kernel_.smoothing_length;
  if (farthest > skin * skin / 4) {
    build_lists();
  }
}

void ClosedFlow::advance(double dt) {
  kick(dt / 2);
  move(dt);
  evaluate_after(dt);
  kick(dt / 2);
  time_ += dt;
  ++steps_;
}

StepLimits ClosedFlow::limits() const {
  StepExtremes e;
  const std::size_t n = particles_.size();
  const auto over_fluid = [&](double least, const auto& value) {
    return block_max(n, least, [&](std::size_t i) { return is_fluid(i) ? value(i) : least; });
  };
  e.smoothing_length = kernel_.smoothing_length;
  e.speed = block_max(n, 0, [&](std::size_t i) {
    const Vector& v = particles_.velocity[i];
    return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  });
  double lightest = model_.fluids.front().density, diffusivity = 0;
  for (const Fluid& fluid : model_.fluids) {
    lightest = std::min(lightest, fluid.density);
    diffusivity = std::max(diffusivity, fluid.conductivity / (fluid.density * fluid.specific_heat));
  }
  e.density = lightest;
  // One stiffness for all: sound is fastest in the lightest fluid.
  e.sound_speed = std::sqrt(model_.stiffness / lightest);
  e.kinematic_viscosity =
      over_fluid(0, [&](std::size_t i) { return fields_.viscosity[i] / particles_.density[i]; });
  e.surface_tension =
      model_.interface ? over_fluid(0, [&](std::size_t i) { return fields_.tension[i]; }) : 0;
  e.thermal_diffusivity = model_.heat ? diffusivity : 0;
  const Vector& g = model_.gravity;
  e.gravity = std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
  return step_limits(e);
}

}  // namespace meltproof::solver

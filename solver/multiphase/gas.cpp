// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/multiphase/gas.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace meltproof::solver {

GasFlow::GasFlow(const Particles& metal, const Domain& domain, const FlowSettings& flow,
                 const GasSettings& gas)
    : metal_(metal.size()), flow_(make(metal, domain, flow, gas)) {}

ClosedFlow GasFlow::make(const Particles& metal, const Domain& domain, const FlowSettings& flow,
                         const GasSettings& gas) {
  const double dx = metal.spacing, volume = dx * dx * dx;
  const double density = metal.mass.front() / metal.volume.front();
  Particles all = metal;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all.identity[i] < 0 || static_cast<std::size_t>(all.identity[i]) >= metal.size()) {
      throw std::logic_error("gas: the metal's identities must be 0 to n-1");
    }
  }
  // Metal stands on a lattice that begins at the domain's lower corner; gas fills the cells that it
  // leaves.
  double top = domain.upper[2];
  for (const Vector& at : metal.position) {
    top = std::max(top, at[2] + dx / 2);
  }
  std::array<std::size_t, 3> count{};
  Domain closed = domain;
  closed.upper[2] = top + std::ceil(gas.height / dx) * dx;
  for (std::size_t d = 0; d < 3; ++d) {
    count[d] = static_cast<std::size_t>(std::llround((closed.upper[d] - closed.lower[d]) / dx));
    closed.face[d] = {Face::mirror, Face::mirror};
    if (domain.face[d][0] == Face::periodic) {
      closed.face[d] = {Face::periodic, Face::periodic};
    }
  }
  std::vector<bool> filled(count[0] * count[1] * count[2], false);
  const auto cell = [&](const Vector& at) {
    std::array<std::size_t, 3> c{};
    for (std::size_t d = 0; d < 3; ++d) {
      const double x = std::floor((at[d] - closed.lower[d]) / dx);
      c[d] = static_cast<std::size_t>(std::clamp(x, 0.0, static_cast<double>(count[d] - 1)));
    }
    return (c[2] * count[1] + c[1]) * count[0] + c[0];
  };
  for (const Vector& at : metal.position) {
    filled[cell(at)] = true;
  }
  std::vector<std::int32_t> fluid(metal.size(), 0);
  auto identity = static_cast<std::int64_t>(metal.size());
  for (std::size_t k = 0; k < count[2]; ++k) {
    for (std::size_t j = 0; j < count[1]; ++j) {
      for (std::size_t i = 0; i < count[0]; ++i) {
        const Vector at{closed.lower[0] + (static_cast<double>(i) + 0.5) * dx,
                        closed.lower[1] + (static_cast<double>(j) + 0.5) * dx,
                        closed.lower[2] + (static_cast<double>(k) + 0.5) * dx};
        if (!filled[cell(at)]) {
          all.add(identity++, at, density / gas.density_ratio * volume, volume, 0, 0,
                  Origin::plate);
          all.phase.back() = Phase::gas;
          fluid.push_back(1);
        }
      }
    }
  }
  ClosedFlowModel model;
  model.domain = closed;
  model.gravity = flow.gravity;
  model.fluids = {{.density = density},
                  {.density = density / gas.density_ratio, .viscosity = gas.viscosity}};
  model.stiffness = density * flow.sound_speed * flow.sound_speed;
  model.background = background_at_rest * model.stiffness;
  model.interface = flow.surface_tension;
  return {std::move(all), std::move(fluid), std::move(model)};
}

int GasFlow::advance(Particles& metal,
                     const std::function<MeltProperties(std::uint32_t)>& properties, double dt) {
  Particles& all = flow_.particles();
  FlowFields& fields = flow_.fields();
  std::vector<std::uint32_t> metal_at(metal_);
  for (std::uint32_t i = 0; i < metal.size(); ++i) {
    metal_at[static_cast<std::size_t>(metal.identity[i])] = i;
  }
  double tension = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto id = static_cast<std::size_t>(all.identity[k]);
    if (id < metal_) {
      const std::uint32_t i = metal_at[id];
      const Phase phase = metal.phase[i] == Phase::liquid ? Phase::liquid : Phase::solid;
      if (phase != all.phase[k]) {
        all.velocity[k] = {};
      }
      all.phase[k] = phase;
      const MeltProperties here = properties(i);
      fields.viscosity[k] = here.viscosity;
      fields.tension[k] = here.surface_tension;
      fields.recoil[k] = here.recoil;
      tension = std::max(tension, phase == Phase::liquid ? here.surface_tension : 0);
    }
  }
  // Both sides of the interface carry a surface tension; the gas takes the melt's largest.
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all.phase[k] == Phase::gas) {
      fields.tension[k] = tension;
    }
  }
  flow_.evaluate();
  const int steps = std::max(1, static_cast<int>(std::ceil(dt / flow_.stable_step())));
  for (int s = 0; s < steps; ++s) {
    flow_.advance(dt / steps);
  }
  const Particles& now = flow_.particles();
  for (std::size_t k = 0; k < now.size(); ++k) {
    const auto id = static_cast<std::size_t>(now.identity[k]);
    if (id < metal_ && now.phase[k] == Phase::liquid) {
      const std::uint32_t i = metal_at[id];
      metal.position[i] = now.position[k];
      metal.velocity[i] = now.velocity[k];
      metal.density[i] = now.density[k];
    }
  }
  return steps;
}

}  // namespace meltproof::solver

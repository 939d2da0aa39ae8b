// SPDX-License-Identifier: GPL-3.0-or-later
// How the engine lets the melt flow between two thermal steps.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "solver/particles/block_sum.hpp"
#include "solver/step/engine.hpp"
#include "solver/step/stopwatch.hpp"

namespace meltproof::solver {
namespace {

/// After so many remade lists the particles are put in order again and all lists are made afresh.
constexpr std::size_t builds_between_sorts = 256;

}  // namespace

void Engine::start_flow() {
  const std::size_t n = particles_.size();
  for (auto* field : {&melt_.viscosity, &melt_.surface_tension, &melt_.recoil}) {
    field->assign(n, 0.0);
  }
  change_phases();
  rebuild_lists(true);
  refresh_melt();
  flow_->set_properties(particles_, ghosts_, neighbours_.list(), melt_);
  flow_->evaluate(particles_, ghosts_, neighbours_.list(), melt_);
  if (model_.gas) {
    gas_.emplace(particles_, model_.domain, flow_->settings(), *model_.gas);
  }
}

/// The closed flow moves the melt; the free surface's interface then says how much of it is bare.
void Engine::advance_gas(double dt) {
  flow_count_ += static_cast<std::size_t>(gas_->advance(particles_, melt_, dt));
  if (farthest_moved() > neighbours_.skin() / 2) {
    rebuild_lists(false);
  }
  flow_->set_properties(particles_, ghosts_, neighbours_.list(), melt_);
  flow_->evaluate(particles_, ghosts_, neighbours_.list(), melt_);
}

void Engine::set_state(const std::vector<Vector>& velocity, const std::vector<double>& density) {
  // By identity, because the engine keeps particles in an order of its own.
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const auto id = static_cast<std::size_t>(particles_.identity[i]);
    particles_.velocity[i] = velocity[id];
    particles_.density[i] = density[id];
  }
  flow_->set_properties(particles_, ghosts_, neighbours_.list(), melt_);
  flow_->evaluate(particles_, ghosts_, neighbours_.list(), melt_);
}

double Engine::largest_speed() const {
  double square = 0;
  for (const std::uint32_t i : flow_->liquid()) {
    const Vector& v = particles_.velocity[i];
    square = std::max(square, v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  }
  return std::sqrt(square);
}

/// How far a liquid particle has come since the lists were made, m.
/// @throws std::runtime_error if one was thrown out, or its place is no number: asked for its
/// neighbours, such a place would ask for all the memory of the machine.
double Engine::farthest_moved() const {
  double square = 0;
  // The step's limits allow half a spacing.
  const double most = particles_.spacing * particles_.spacing;
  for (const std::uint32_t i : flow_->liquid()) {
    const Vector &a = particles_.position[i], &b = built_at_[i];
    const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    const double moved = x * x + y * y + z * z;
    // False for what is no number, too.
    if (!(moved <= most)) {
      report_unstable(i, std::sqrt(moved));
    }
    square = std::max(square, moved);
  }
  return std::sqrt(square);
}

void Engine::report_unstable(std::uint32_t particle, double moved) const {
  // What is no number spreads from where it arose: there the density is none, too.
  for (const std::uint32_t i : flow_->liquid()) {
    if (!std::isfinite(particles_.density[i])) {
      particle = i;
      break;
    }
  }
  const Vector& at = built_at_[particle];
  throw std::runtime_error(fmt::format(
      "step {}, time {:.6g} s, particle {}, last listed at ({:.3g}, {:.3g}, {:.3g}) um: it moved "
      "by {:.3g} spacings within a few steps, so the flow is unstable; the force behind it: {}. A "
      "larger flow.viscosity_factor or flow.sound_speed, or the default flow.clumping_cure, may "
      "hold it",
      steps_, time_, particles_.identity[particle], 1e6 * at[0], 1e6 * at[1], 1e6 * at[2],
      moved / particles_.spacing, flow_->diagnose(particles_, particle, melt_)));
}

/// Melts and freezes; takes out what left the domain. @returns whether any phase changed.
bool Engine::change_phases() {
  const std::size_t n = particles_.size();
  const NeighbourList& list = neighbours_.list();
  const double touch = 2.25 * particles_.spacing * particles_.spacing;
  std::vector<std::uint32_t> freezing;
  bool changed = false;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double fraction = particles_.liquid_fraction[i];
    if (particles_.phase[i] == Phase::solid && fraction >= 1) {
      particles_.phase[i] = Phase::liquid;
      particles_.velocity[i] = {};
      particles_.density[i] = particles_.mass[i] / particles_.volume[i];
      changed = true;
    } else if (particles_.phase[i] == Phase::liquid && fraction < model_.freezing_fraction) {
      freezing.push_back(i);
    }
  }
  // A drop in flight that cools stays in flight: melt freezes to something that stands still. What
  // freezes in this step does not count for the others, so that their order does not matter.
  std::vector<std::uint8_t> touches(freezing.size(), 0);
  for (std::size_t f = 0; f < freezing.size(); ++f) {
    const Vector& at = particles_.position[freezing[f]];
    for (std::size_t k = list.first[freezing[f]]; k < list.last[freezing[f]]; ++k) {
      const std::uint32_t j = list.index[k];
      if (j < n && particles_.phase[j] == Phase::solid) {
        const Vector& other = particles_.position[j];
        const double x = at[0] - other[0], y = at[1] - other[1], z = at[2] - other[2];
        touches[f] = touches[f] != 0 || x * x + y * y + z * z < touch ? 1 : 0;
      }
    }
  }
  for (std::size_t f = 0; f < freezing.size(); ++f) {
    if (touches[f] != 0) {
      const std::uint32_t i = freezing[f];
      particles_.phase[i] = Phase::solid;
      particles_.velocity[i] = {};
      particles_.density[i] = particles_.mass[i] / particles_.volume[i];
      changed = true;
    }
  }
  const Domain& domain = model_.domain;
  // Spatter may rise; half a millimetre above everything it is gone.
  constexpr double sky = 0.5e-3;
  for (const std::uint32_t i : flow_->liquid()) {
    bool outside = false;
    for (std::size_t d = 0; d < static_cast<std::size_t>(3); ++d) {
      const bool open_low = domain.face[d][0] == Face::open;
      const bool open_high = domain.face[d][1] == Face::open;
      const double x = particles_.position[i][d];
      outside = outside || (open_low && x < domain.lower[d]) ||
                (open_high && x > domain.upper[d] + (d == 2 ? sky : 0));
    }
    if (outside && particles_.phase[i] == Phase::liquid) {
      particles_.phase[i] = Phase::lost;
      particles_.velocity[i] = {};
      diffusivity_[i] = 0;
      ++lost_;
      changed = true;
    }
  }
  return changed;
}

/// Properties of the melt at the present temperature and composition.
void Engine::refresh_melt() {
  const FlowSettings& settings = flow_->settings();
  const double ambient = model_.surface_loss ? model_.surface_loss->ambient_pressure
                                             : SurfaceLossSettings{}.ambient_pressure;
  const auto refresh_one = [&](std::uint32_t i) {
    const double temperature = particles_.temperature[i],
                 concentration = particles_.concentration[i];
    melt_.surface_tension[i] = mixture_.surface_tension(temperature, concentration);
    melt_.viscosity[i] = settings.viscosity_factor * mixture_.viscosity(temperature, concentration);
    melt_.recoil[i] = settings.recoil && temperature > 1000
                          ? recoil_pressure(temperature, concentration, mixture_, ambient)
                          : 0;
  };
  const auto& liquid = flow_->liquid();
  const auto& wall = flow_->wall();
  for_each_particle(liquid.size(), [&](std::size_t k) { refresh_one(liquid[k]); });
  for_each_particle(wall.size(), [&](std::size_t k) { refresh_one(wall[k]); });
}

void Engine::rebuild_lists(bool everything) {
  const std::size_t n = particles_.size();
  const Domain& domain = model_.domain;
  for (std::size_t d = 0; d < 3; ++d) {
    if (domain.face[d][0] == Face::periodic) {
      const double length = domain.upper[d] - domain.lower[d];
      for (const std::uint32_t i : flow_->liquid()) {
        double& x = particles_.position[i][d];
        x += x < domain.lower[d] ? length : x >= domain.upper[d] ? -length : 0;
      }
    }
  }
  if (everything) {
    sort_in_space(particles_, 3 * kernel_.smoothing_length);
    builds_since_sort_ = 0;
    // Everybody has a new index: what was kept by the old ones is made afresh.
    liquid_.clear();
    for (auto& record : species_records_) {
      record.diffusivity = 0;
    }
    for_each_particle(n, [&](std::size_t i) { refresh(i); });
  }
  for (std::size_t i = 0; i < n; ++i) {
    mobile_[i] = particles_.phase[i] == Phase::liquid ||
                         (particles_.phase[i] == Phase::solid && particles_.liquid_fraction[i] > 0)
                     ? 1
                     : 0;
  }
  ghosts_ = make_ghosts(particles_, domain, kernel_.support() + neighbours_.skin());
  if (everything) {
    neighbours_.build(particles_, ghosts_, mobile_);
  } else {
    neighbours_.rebuild(particles_, ghosts_, mobile_);
  }
  ++list_builds_;
  ++builds_since_sort_;
  flow_->arrange(particles_, ghosts_, neighbours_.list(), everything || !ghosts_.empty());
  built_at_ = particles_.position;
  place_records();
  if (model_.surface_conduction) {
    surface_conduction_.update(heat_records_, ghosts_, neighbours_.list(), kernel_,
                               everything ? nullptr : &heat_active_);
  }
  refresh_ghosts();
}

void Engine::advance_flow(double dt, int steps) {
  Stopwatch watch;
  if (change_phases()) {
    bool listed = true;
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      listed = listed && (particles_.phase[i] != Phase::liquid || mobile_[i] != 0);
    }
    if (listed) {
      flow_->arrange(particles_, ghosts_, neighbours_.list(), !ghosts_.empty());
    } else {
      rebuild_lists(false);
    }
  }
  if (builds_since_sort_ > builds_between_sorts) {
    rebuild_lists(true);
    refresh_melt();
    flow_->set_properties(particles_, ghosts_, neighbours_.list(), melt_);
    flow_->evaluate(particles_, ghosts_, neighbours_.list(), melt_);
  }
  watch.lap(times_.lists);
  if (flow_->liquid().empty()) {
    return;
  }
  refresh_melt();
  flow_->set_properties(particles_, ghosts_, neighbours_.list(), melt_);
  if (gas_) {
    advance_gas(dt);
    place_records();
    watch.lap(times_.flow);
    return;
  }
  const double small = dt / steps;
  const double allowed = neighbours_.skin() / 2;
  for (int s = 0; s < steps; ++s) {
    flow_->kick_and_drift(particles_, small);
    ++flow_count_;
    const double farthest = farthest_moved();
    watch.lap(times_.flow);
    if (farthest > allowed) {
      rebuild_lists(false);
      watch.lap(times_.lists);
    }
    flow_->finish(particles_, ghosts_, neighbours_.list(), melt_, small);
    watch.lap(times_.flow);
  }
  place_records();
  watch.lap(times_.lists);
}

}  // namespace meltproof::solver

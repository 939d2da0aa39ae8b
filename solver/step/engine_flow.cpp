// SPDX-License-Identifier: GPL-3.0-or-later
// How the engine lets the melt flow between two thermal steps.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "solver/particles/loops.hpp"
#include "solver/step/engine.hpp"
#include "solver/step/stopwatch.hpp"

namespace meltproof::solver {

void Engine::start_flow() {
  change_phases();
  rebuild_lists(true);
  refresh_melt();
  flow_->set_properties(particles_, ghosts_);
  flow_->evaluate(particles_, ghosts_);
  if (model_.gas) {
    gas_.emplace(particles_, model_.domain, flow_->settings(), *model_.gas);
  }
}

/// The closed flow moves the melt; the free surface's interface then says how much of it is bare.
void Engine::advance_gas(double dt) {
  flow_count_ += static_cast<std::size_t>(gas_->advance(
      particles_, [&](std::uint32_t i) { return flow_->properties(i); }, dt));
  if (farthest_moved() > neighbours_.skin() / 2) {
    rebuild_lists(false);
  }
  flow_->set_properties(particles_, ghosts_);
  flow_->evaluate(particles_, ghosts_);
}

void Engine::set_state(const std::vector<Vector>& velocity, const std::vector<double>& density) {
  // By identity, because the engine keeps particles in an order of its own.
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const auto id = static_cast<std::size_t>(particles_.identity[i]);
    particles_.velocity[i] = velocity[id];
    particles_.density[i] = density[id];
  }
  flow_->set_properties(particles_, ghosts_);
  flow_->evaluate(particles_, ghosts_);
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
  for (std::size_t k = 0; k < movers_.size(); ++k) {
    const std::uint32_t i = movers_[k];
    if (particles_.phase[i] != Phase::liquid || particles_.home[i] != Home::here) {
      continue;
    }
    const Vector &a = particles_.position[i], &b = built_at_[k];
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
  const Vector at = listed_at(particle);
  throw std::runtime_error(fmt::format(
      "step {}, time {:.6g} s, particle {}, last listed at ({:.3g}, {:.3g}, {:.3g}) um: it moved "
      "by {:.3g} spacings within a few steps, so the flow is unstable; the force behind it: {}. A "
      "larger flow.viscosity_factor or flow.sound_speed, or the default flow.clumping_cure, may "
      "hold it",
      steps_, time_, particles_.identity[particle], 1e6 * at[0], 1e6 * at[1], 1e6 * at[2],
      moved / particles_.spacing, flow_->diagnose(particles_, particle)));
}

/// Properties of the melt at the present temperature and composition.
void Engine::refresh_melt() {
  const FlowSettings& settings = flow_->settings();
  const double ambient = model_.surface_loss ? model_.surface_loss->ambient_pressure
                                             : SurfaceLossSettings{}.ambient_pressure;
  flow_->set_melt([&](std::uint32_t i) {
    const double temperature = particles_.temperature[i],
                 concentration = particles_.concentration[i];
    return MeltProperties{
        .viscosity = settings.viscosity_factor * mixture_.viscosity(temperature, concentration),
        .surface_tension = mixture_.surface_tension(temperature, concentration),
        .recoil = settings.recoil && temperature > 1000
                      ? recoil_pressure(temperature, concentration, mixture_, ambient)
                      : 0};
  });
}

/// In a periodic domain the melt's particles stay between the faces.
void Engine::keep_in_period() {
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
}

/// Space-filling order, and with several ranks new parts of space for them.
void Engine::sort_particles() {
  if (ranks().alone()) {
    sort_in_space(particles_, 3 * kernel_.smoothing_length);
    flow_->forget();
  } else {
    costs_ = unit_costs();
    divide_anew(true);
  }
  builds_since_sort_ = 0;
}

/// Of the lists just made, at the places for which they were made.
void Engine::find_movers() {
  select_indices(
      mobile_.size(), [&](std::uint32_t i) { return mobile_[i] != 0; }, movers_);
  built_at_.resize(movers_.size());
  std::transform(movers_.begin(), movers_.end(), built_at_.begin(),
                 [&](std::uint32_t i) { return particles_.position[i]; });
}

/// Where a particle was when the lists were made, m.
Vector Engine::listed_at(std::uint32_t i) const {
  const auto found = std::lower_bound(movers_.begin(), movers_.end(), i);
  return found != movers_.end() && *found == i
             ? built_at_[static_cast<std::size_t>(found - movers_.begin())]
             : particles_.position[i];
}

void Engine::rebuild_lists(bool everything) {
  keep_in_period();
  if (everything) {
    sort_particles();
  }
  const std::vector<std::uint8_t> before = mobile_;
  for_each_particle(particles_.size(), [&](std::size_t i) {
    const bool moves = particles_.phase[i] == Phase::liquid ||
                       (particles_.phase[i] == Phase::solid && particles_.liquid_fraction[i] > 0);
    mobile_[i] = moves && particles_.home[i] != Home::nowhere ? 1 : 0;
  });
  Moved moved;
  if (!everything && !ranks().alone()) {
    if (out_of_balance()) {
      divide_anew(false);
      everything = true;
    } else {
      moved = move_between_ranks(before);
      everything = slots_added_;
    }
  }
  slots_added_ = false;
  ghosts_ = make_ghosts(particles_, model_.domain, kernel_.support() + neighbours_.skin());
  if (everything || !model_.keep_lists) {
    neighbours_.build(particles_, ghosts_, mobile_);
  } else {
    neighbours_.rebuild(particles_, ghosts_, mobile_, moved.arrived);
  }
  boundary_stale_ = true;
  ++list_builds_;
  ++builds_since_sort_;
  flow_->arrange(particles_, ghosts_, neighbours_.list());
  if (everything || !ghosts_.empty()) {
    find_movers();
    place_records();
  } else {
    place_moving_records();  // of those who have been lost since then, too
    find_movers();
    place_moving_records();
    for (const std::uint32_t i : moved.entries) {
      place_record(i, i, particles_.position[i]);
    }
  }
  if (everything) {
    surface_search_.forget();
  } else {
    surface_search_.moves(movers_);
    surface_search_.moves(moved.entries);  // another particle may stand there now
  }
  if (everything) {
    // Everybody has a new index: what was kept by the old ones is made afresh.
    liquid_.clear();
    for_each_particle(particles_.size(), [&](std::size_t i) { refresh(i); });
  }
  for (const std::uint32_t i : moved.entries) {
    refresh(i);
  }
  if (model_.surface_conduction) {
    surface_conduction_.update(heat_records_, ghosts_, neighbours_.list(), kernel_,
                               everything ? nullptr : &heat_active_);
  }
  refresh_ghosts();
}

void Engine::advance_flow(double dt, int steps) {
  Stopwatch watch;
  if (change_phases()) {
    std::vector<std::uint32_t> unlisted;
    select_indices(
        particles_.size(),
        [&](std::uint32_t i) {
          return particles_.phase[i] == Phase::liquid && mobile_[i] == 0 &&
                 particles_.home[i] != Home::nowhere;
        },
        unlisted);
    if (ranks().any(!unlisted.empty())) {
      rebuild_lists(false);
    } else {
      flow_->arrange(particles_, ghosts_, neighbours_.list());
    }
  }
  if (sort_due_) {
    rebuild_lists(true);
    refresh_melt();
    flow_->set_properties(particles_, ghosts_);
    flow_->evaluate(particles_, ghosts_);
  }
  watch.lap(times_.lists);
  if (!ranks().any(!flow_->liquid().empty())) {
    return;
  }
  refresh_melt();
  flow_->set_properties(particles_, ghosts_);
  if (gas_) {
    advance_gas(dt);
    place_moving_records();
    watch.lap(times_.flow);
    return;
  }
  const double small = dt / steps;
  const double allowed = neighbours_.skin() / 2;
  for (int s = 0; s < steps; ++s) {
    flow_->kick_and_drift(particles_, small);
    ++flow_count_;
    const double farthest = ranks().largest(farthest_moved());
    watch.lap(times_.flow);
    if (farthest > allowed) {
      rebuild_lists(false);
      watch.lap(times_.lists);
    } else {
      flow_->follow(particles_);
    }
    flow_->finish(particles_, ghosts_, small);
    watch.lap(times_.flow);
  }
  place_moving_records();
  watch.lap(times_.lists);
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// How long a thermal step is, and its order of events.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "solver/particles/loops.hpp"
#include "solver/step/engine.hpp"
#include "solver/step/stopwatch.hpp"
#include "solver/terms/reflection.hpp"

namespace meltproof::solver {
namespace {

/// After so many remade lists the particles are put in order again and all lists are made afresh.
constexpr std::size_t builds_between_sorts = 256;

/// Of the thermal limit, how long a round of heat steps is, see exchange_heat(): 0.25 h^2 rho
/// c_p/k. Up to there no exchange on a lattice makes a temperature that was not there before, and
/// twice that is where it becomes unstable: the largest eigenvalue of its Laplacian is 4.0/h^2.
constexpr double round_over_limit = 2;

}  // namespace

double Engine::thermal_limit(double diffusivity) const {
  StepExtremes heat;
  heat.smoothing_length = kernel_.smoothing_length;
  heat.thermal_diffusivity = diffusivity;
  return step_limits(heat).thermal;
}

/// The step by all criteria, where it ends, and into how many steps of the flow it falls.
Engine::Step Engine::choose_step(double until, double surface_rate) const {
  const std::size_t n = particles_.size();
  // Of all ranks in one go: thermal diffusivity of what may take substeps and of what may not,
  // that of species, rate of the surface, and of the melt whether there is any, speed, kinematic
  // viscosity, surface tension, least density.
  enum : std::size_t {
    best,
    thermal,
    species,
    surface,
    melt,
    speed,
    viscosity,
    tension,
    density,
    all
  };
  std::array<double, all> extreme{};
  extreme[surface] = surface_rate;
  if (model_.conduction) {
    const auto apart = [&](std::size_t i) {
      return round_open_ ? pace_[i] > pace::every_step : thermal_diffusivity_[i] > best_of_base_;
    };
    extreme[thermal] =
        block_max(n, 0.0, [&](std::size_t i) { return apart(i) ? 0.0 : thermal_diffusivity_[i]; });
    extreme[best] =
        block_max(n, 0.0, [&](std::size_t i) { return apart(i) ? thermal_diffusivity_[i] : 0.0; });
  }
  if (model_.species) {
    extreme[species] = block_max(n, 0.0, [&](std::size_t i) { return diffusivity_[i]; });
  }
  extreme[density] = -std::numeric_limits<double>::infinity();
  if (flow_) {
    extreme[melt] = flow_->liquid().empty() ? 0 : 1;
    extreme[speed] = largest_speed();
    for (const std::uint32_t i : flow_->liquid()) {
      const MeltProperties melt_here = flow_->properties(i);
      extreme[viscosity] =
          std::max(extreme[viscosity], melt_here.viscosity / particles_.density[i]);
      extreme[tension] = std::max(extreme[tension], melt_here.surface_tension);
      extreme[density] = std::max(extreme[density], -particles_.density[i]);
    }
  }
  ranks().largest(extreme);
  StepExtremes extremes;
  extremes.smoothing_length = kernel_.smoothing_length;
  extremes.surface_rate = extreme[surface];
  extremes.species_diffusivity = extreme[species];
  Step step;
  step.limits = step_limits(extremes);
  double dt = step.limits.smallest(), flow_limit = std::numeric_limits<double>::infinity();
  if (extreme[melt] > 0) {
    StepExtremes motion;
    motion.smoothing_length = kernel_.smoothing_length;
    motion.sound_speed = flow_->settings().sound_speed;
    motion.courant = flow_->settings().courant;
    motion.speed = extreme[speed];
    motion.gravity = std::hypot(flow_->settings().gravity[0], flow_->settings().gravity[1],
                                flow_->settings().gravity[2]);
    motion.kinematic_viscosity = extreme[viscosity];
    motion.surface_tension = flow_->settings().surface_tension ? extreme[tension] : 0;
    motion.density = -extreme[density];
    const StepLimits flow_limits = step_limits(motion);
    flow_limit = model_.step_factor * flow_limits.smallest();
    // Within one thermal step nothing moves by more than a quarter of a spacing.
    dt = std::min({dt, model_.flow_steps * flow_limits.smallest(),
                   motion.speed > 0 ? 0.25 * particles_.spacing / motion.speed : dt});
    step.limits.acoustic = flow_limits.acoustic;
    step.limits.viscous = flow_limits.viscous;
    step.limits.capillary = flow_limits.capillary;
    step.limits.gravity = flow_limits.gravity;
  }
  const double limit_of_best = thermal_limit(extreme[best]);
  step.limits.thermal = thermal_limit(extreme[thermal]);
  // Substeps are for where those that conduct best would hold the step back. Within a round nobody
  // changes pace.
  const bool substeps = extreme[best] > 0 &&
                        (round_open_ || (heat_holds_ && extreme[melt] > 0 && limit_of_best < dt));
  if (!substeps) {
    step.limits.thermal = std::min(step.limits.thermal, limit_of_best);
  }
  dt = std::min(dt, step.limits.thermal);
  if (!std::isfinite(dt)) {
    dt = until - time_;
  }
  dt *= model_.step_factor;
  // The round that is under way was not closed because another step as long as the last one fits.
  step.round = round_over_limit * model_.step_factor * step.limits.thermal;
  const double left = step.round - round_time_;
  if (round_open_ && left > 0) {
    dt = std::min(dt, left);
  }
  double end = until;
  if (model_.laser && model_.laser->on(time_)) {
    // The beam is switched off exactly at the end of a step, so that its energy is P times its
    // exposure.
    end = std::min(end, model_.laser->exposure);
  }
  // A remainder much shorter than a step is shared with the step before it.
  if (time_ + dt >= end) {
    dt = end - time_;
    step.end = end;
  } else {
    if (time_ + 2 * dt > end) {
      dt = (end - time_) / 2;
    }
    step.end = time_ + dt;
  }
  step.size = dt;
  step.flow_steps = std::max(1, static_cast<int>(std::ceil(dt / flow_limit)));
  if (substeps) {
    step.heat_substeps =
        std::max(1, static_cast<int>(std::ceil(dt / (model_.step_factor * limit_of_best))));
  }
  return step;
}

/// What this step brought each particle, and all that follows from it.
void Engine::apply(double dt) {
  std::vector<Crossing> crossings;
  for_each_particle(particles_.size(), [&](std::size_t i) {
    // What exchanges nothing stays as it is; additive is exchanged where it diffuses.
    if (particles_.home[i] != Home::here ||
        (conducted_[i] == 0 && source_[i] == 0 && diffusivity_[i] == 0)) {
      return;
    }
    const bool whole_round = round_closes_ && pace_[i] == pace::slow;
    Crossing c{.particle = static_cast<std::uint32_t>(i),
               .old_enthalpy = particles_.enthalpy[i],
               .old_temperature = particles_.temperature[i],
               .begin = whole_round ? time_ + dt - round_time_ : time_,
               .size = whole_round ? round_time_ : dt};
    particles_.enthalpy[i] +=
        dt * (conducted_[i] * particles_.volume[i] + source_[i]) / particles_.mass[i];
    refresh(i);
    const double liquidus = mixture_.liquidus(particles_.concentration[i]);
    if ((c.old_temperature >= liquidus) != (particles_.temperature[i] >= liquidus)) {
#pragma omp critical(crossings)
      crossings.push_back(c);
    }
  });
  update_copies();
  // Apart from the loop above, because a gradient looks at the neighbours' new temperatures.
  for (const Crossing& c : crossings) {
    note_phase_times(c);
  }
  if (round_closes_) {
    round_open_ = round_closes_ = false;
    round_time_ = 0;
  }
}

double Engine::step(double until) {
  // The state belongs to the present enthalpy and concentration: the constructor and the end of
  // each step see to that.
  // Known before the heat is exchanged: a round of its steps ends with a sort.
  sort_due_ = builds_since_sort_ > builds_between_sorts;
  Stopwatch watch;
  if (flow_) {
    look_from_above();
  }
  const double surface_rate = lose_surface_heat();
  const Step step = choose_step(until, surface_rate);
  const double dt = step.size;
  limits_ = step.limits;
  beam_ = {};
  if (model_.laser && model_.laser->on(time_)) {
    // The beam stands where it is in the middle of the step.
    const auto absorptivity = [&](std::uint32_t i) {
      return mixture_.absorptivity(particles_.concentration[i]);
    };
    beam_ =
        model_.laser->reflections
            ? irradiate_with_reflections(*model_.laser, time_ + dt / 2, surface_, particles_,
                                         kernel_, absorptivity, source_, ranks())
            : irradiate(*model_.laser, time_ + dt / 2, surface_, absorptivity, source_, ranks());
  }
  watch.lap(times_.surface);
  if (model_.conduction) {
    exchange_heat(step);
  }
  watch.lap(times_.heat);
  if (model_.species) {
    advance_species(dt);
  }
  watch.lap(times_.species);
  apply(dt);
  watch.lap(times_.state);
  ledger_.absorbed += dt * beam_.absorbed;
  ledger_.reflected += dt * beam_.reflected;
  ledger_.missed += dt * beam_.missed;
  ledger_.evaporated += dt * loss_.evaporation;
  ledger_.radiated += dt * loss_.radiation;
  ledger_.convected += dt * loss_.convection;
  ledger_.evaporated_mass += dt * loss_.mass_rate;
  if (flow_) {
    advance_flow(dt, step.flow_steps);
  }
  refresh_ghosts();
  time_ = step.end;
  ++steps_;
  check_numbers();
  return dt;
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// How long a thermal step is, and its order of events.
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/particles/block_sum.hpp"
#include "solver/step/engine.hpp"
#include "solver/step/stopwatch.hpp"

namespace meltproof::solver {

/// The step by all criteria, where it ends, and into how many steps of the flow it falls.
Engine::Step Engine::choose_step(double until, double surface_rate) const {
  const std::size_t n = particles_.size();
  StepExtremes extremes;
  extremes.smoothing_length = kernel_.smoothing_length;
  extremes.surface_rate = surface_rate;
  if (model_.conduction) {
    extremes.thermal_diffusivity =
        block_max(n, 0.0, [&](std::size_t i) { return thermal_diffusivity_[i]; });
  }
  if (model_.species) {
    extremes.species_diffusivity =
        block_max(n, 0.0, [&](std::size_t i) { return diffusivity_[i]; });
  }
  Step step;
  step.limits = step_limits(extremes);
  double dt = step.limits.smallest(), flow_limit = std::numeric_limits<double>::infinity();
  if (flow_ && !flow_->liquid().empty()) {
    StepExtremes motion;
    motion.smoothing_length = kernel_.smoothing_length;
    motion.sound_speed = flow_->settings().sound_speed;
    motion.speed = largest_speed();
    motion.density = std::numeric_limits<double>::infinity();
    motion.gravity = std::hypot(flow_->settings().gravity[0], flow_->settings().gravity[1],
                                flow_->settings().gravity[2]);
    for (const std::uint32_t i : flow_->liquid()) {
      const double density = particles_.density[i];
      motion.kinematic_viscosity =
          std::max(motion.kinematic_viscosity, melt_.viscosity[i] / density);
      motion.surface_tension = std::max(motion.surface_tension, melt_.surface_tension[i]);
      motion.density = std::min(motion.density, density);
    }
    if (!flow_->settings().surface_tension) {
      motion.surface_tension = 0;
    }
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
  if (!std::isfinite(dt)) {
    dt = until - time_;
  }
  dt *= model_.step_factor;
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
  return step;
}

double Engine::step(double until) {
  // The state belongs to the present enthalpy and concentration: the constructor and the end of
  // each step see to that.
  const std::size_t n = particles_.size();
  Stopwatch watch;
  if (flow_ && (model_.laser || model_.surface_loss)) {
    surface_ = find_surface(particles_, model_.domain.lower, model_.domain.upper,
                            model_.laser ? model_.laser->slant() : Slant{});
  }
  const double surface_rate = lose_surface_heat();
  const Step step = choose_step(until, surface_rate);
  const double dt = step.size;
  limits_ = step.limits;
  beam_ = {};
  if (model_.laser && model_.laser->on(time_)) {
    // The beam stands where it is in the middle of the step.
    beam_ = irradiate(*model_.laser, time_ + dt / 2, surface_, absorptivity_, source_);
  }
  watch.lap(times_.surface);
  if (model_.conduction) {
    find_awake(heat_records_, neighbours_.list(), heat_active_);
    conduct(heat_records_, neighbours_.list(), kernel_, heat_active_, conducted_);
    if (model_.surface_conduction) {
      surface_conduction_.add(heat_records_, neighbours_.list(), kernel_, heat_active_, conducted_);
    }
  }
  watch.lap(times_.heat);
  if (model_.species) {
    advance_species(dt);
  }
  watch.lap(times_.species);
  old_enthalpy_ = particles_.enthalpy;
  old_temperature_ = particles_.temperature;
  for_each_particle(n, [&](std::size_t i) {
    particles_.enthalpy[i] +=
        dt * (conducted_[i] * particles_.volume[i] + source_[i]) / particles_.mass[i];
    refresh(i);
  });
  // Apart from the loop above, because a gradient looks at the neighbours' new temperatures.
  for_each_particle(
      n, [&](std::size_t i) { note_phase_times(i, old_enthalpy_[i], old_temperature_[i], dt); });
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/step/engine.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "solver/particles/block_sum.hpp"

namespace meltproof::solver {
namespace {

QuinticSpline lattice_kernel(const Particles& particles, double smoothing_ratio,
                             LatticeMoments moments) {
  QuinticSpline kernel(smoothing_ratio * particles.spacing, particles.dimensions);
  set_lattice_moments(kernel, particles.spacing, particles.dimensions, moments);
  return kernel;
}

Particles sorted(Particles particles, double smoothing_ratio) {
  sort_in_space(particles, 3 * smoothing_ratio * particles.spacing);
  return particles;
}

/// Wall-clock time, added up by lap.
class Stopwatch {
 public:
  void lap(double& sum) {
    const auto now = std::chrono::steady_clock::now();
    sum += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

Engine::Engine(Particles particles, Mixture mixture, Diffusivity diffusivity, const Model& model)
    : particles_(sorted(std::move(particles), model.smoothing_ratio)),
      mixture_(std::move(mixture)),
      diffusivity_law_(std::move(diffusivity)),
      model_(model),
      kernel_(lattice_kernel(particles_, model.smoothing_ratio, model.heat_moments)),
      species_kernel_(lattice_kernel(particles_, model.smoothing_ratio, model.species_moments)),
      neighbours_(kernel_.support(), model.flow ? model.flow->skin * particles_.spacing : 0) {
  const std::size_t n = particles_.size();
  mobile_.assign(n, 0);
  for (auto* field : {&thermal_diffusivity_, &diffusivity_, &conducted_, &source_, &rate_,
                      &absorptivity_, &loss_area_}) {
    field->assign(n, 0.0);
  }
  if (model_.flow) {
    flow_.emplace(*model_.flow, kernel_, particles_.spacing, particles_.dimensions);
  }
  ghosts_ = make_ghosts(particles_, model_.domain, kernel_.support() + neighbours_.skin());
  neighbours_.build(particles_, ghosts_, mobile_);
  place_records();
  if (model_.surface_conduction) {
    surface_conduction_.update(heat_records_, ghosts_, neighbours_.list(), kernel_);
  }
  // Without sleep no temperature is the start's, and everybody is awake.
  start_temperature_ =
      model_.sleep_below > 0 && n > 0
          ? mixture_.temperature(particles_.enthalpy[0], particles_.concentration[0])
          : -1e9;
  for_each_particle(n, [&](std::size_t i) { refresh(i); });
  refresh_ghosts();
  if (model_.laser || model_.surface_loss) {
    surface_ = find_surface(particles_, model_.domain.lower, model_.domain.upper,
                            model_.laser ? model_.laser->slant() : Slant{});
  }
  check_numbers();
  if (flow_) {
    start_flow();
  }
}

/// Positions and volumes of the records: once for fixed particles, every thermal step for moving
/// ones.
void Engine::place_records() {
  const std::size_t n = particles_.size(), all = neighbours_.list().void_index + std::size_t{1};
  heat_records_.resize(all);
  species_records_.resize(all);
  const auto place = [&](std::size_t at, std::size_t source, const Vector& position) {
    const double volume = particles_.volume[source];
    auto& heat = heat_records_[at];
    auto& species = species_records_[at];
    if (particles_.phase[source] == Phase::lost) {
      heat = {};
      species = {};
      return;
    }
    heat.x = species.x = position[0];
    heat.y = species.y = position[1];
    heat.z = species.z = position[2];
    heat.volume = species.volume = volume;
    species.density = particles_.mass[source] / volume;
  };
  for_each_particle(n, [&](std::size_t i) { place(i, i, particles_.position[i]); });
  for (std::size_t g = 0; g < ghosts_.size(); ++g) {
    const std::uint32_t source = ghosts_[g].source;
    place(n + g, source, ghosts_[g].image_of(particles_.position[source]));
  }
  heat_records_.back() = {};
  heat_records_.back().awake = 0;
  species_records_.back() = {};
}

double Engine::total_enthalpy() const {
  return block_sum(particles_.size(),
                   [&](std::size_t i) { return particles_.mass[i] * particles_.enthalpy[i]; });
}

double Engine::total_additive_mass() const {
  return block_sum(particles_.size(),
                   [&](std::size_t i) { return particles_.mass[i] * particles_.concentration[i]; });
}

/// Everything that follows from a particle's enthalpy and concentration, its record included.
void Engine::refresh(std::size_t i) {
  const double enthalpy = particles_.enthalpy[i], concentration = particles_.concentration[i];
  const double temperature = mixture_.temperature(enthalpy, concentration);
  const double liquid = mixture_.liquid_fraction(enthalpy, concentration);
  particles_.temperature[i] = temperature;
  particles_.liquid_fraction[i] = liquid;
  particles_.peak_temperature[i] = std::max(particles_.peak_temperature[i], temperature);
  if (liquid >= 1) {
    particles_.melted[i] = 1;
  }
  const double conductivity = mixture_.conductivity(temperature, concentration);
  thermal_diffusivity_[i] =
      conductivity * particles_.volume[i] /
      (particles_.mass[i] * mixture_.smallest_specific_heat_near(temperature, concentration));
  // The liquid part of a mushy particle diffuses, so D rises continuously from the solidus on.
  // What was lost exchanges nothing any more.
  const bool mixes = liquid > 0 && particles_.phase[i] != Phase::lost;
  diffusivity_[i] = mixes ? liquid * diffusivity_law_(temperature) : 0;
  absorptivity_[i] = mixture_.absorptivity(concentration);
  heat_records_[i].temperature = temperature;
  heat_records_[i].conductivity = conductivity;
  heat_records_[i].awake = std::abs(temperature - start_temperature_) > model_.sleep_below ? 1 : 0;
}

void Engine::refresh_ghosts() {
  const std::size_t n = particles_.size();
  for_each_particle(ghosts_.size(), [&](std::size_t g) {
    const Ghost& ghost = ghosts_[g];
    heat_records_[n + g].temperature =
        ghost.sign * particles_.temperature[ghost.source] + ghost.offset;
    heat_records_[n + g].conductivity = heat_records_[ghost.source].conductivity;
    heat_records_[n + g].awake = heat_records_[ghost.source].awake;
  });
}

void Engine::check_numbers() const {
  const auto where = [&](std::size_t i) {
    const auto& at = particles_.position[i];
    return fmt::format("step {}, time {:.6g} s, particle {} at ({:.3g}, {:.3g}, {:.3g}) um", steps_,
                       time_, particles_.identity[i], 1e6 * at[0], 1e6 * at[1], 1e6 * at[2]);
  };
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    if (!std::isfinite(particles_.temperature[i])) {
      throw std::runtime_error(fmt::format(
          "{}: the temperature is not a number (enthalpy {:.6g} J/kg, concentration {:.6g}; last "
          "conducted power {:.6g} W/m3, source {:.6g} W)",
          where(i), particles_.enthalpy[i], particles_.concentration[i], conducted_[i],
          source_[i]));
    }
  }
  if (flow_) {
    for (const std::uint32_t i : flow_->liquid()) {
      const auto &v = particles_.velocity[i], &x = particles_.position[i];
      if (!std::isfinite(v[0] + v[1] + v[2] + x[0] + x[1] + x[2] + particles_.density[i])) {
        throw std::runtime_error(
            fmt::format("{}: the motion is not a number; the first term that is none: {}", where(i),
                        flow_->diagnose(particles_, i, melt_)));
      }
    }
  }
}

/// Writes the liquid particles and their images; those that were liquid before and no longer are
/// get no diffusivity, and the others never had one.
void Engine::fill_species_records(const std::vector<double>& concentration) {
  for (const std::uint32_t i : liquid_) {
    species_records_[i].concentration = concentration[i];
    species_records_[i].diffusivity = diffusivity_[i];
  }
  const std::size_t n = particles_.size();
  for (std::size_t g = 0; g < ghosts_.size(); ++g) {
    species_records_[n + g].concentration = concentration[ghosts_[g].source];
    species_records_[n + g].diffusivity = diffusivity_[ghosts_[g].source];
  }
}

void Engine::advance_species(double dt) {
  // Only liquid particles exchange: D is zero in the solid, and the pair term with it.
  for (const std::uint32_t i : liquid_) {
    species_records_[i].diffusivity = 0;
  }
  liquid_.clear();
  for (std::uint32_t i = 0; i < particles_.size(); ++i) {
    if (diffusivity_[i] > 0) {
      liquid_.push_back(i);
    }
  }
  if (liquid_.empty()) {
    return;
  }
  fill_species_records(particles_.concentration);
  diffuse(species_records_, neighbours_.list(), species_kernel_, model_.species_factor, liquid_,
          rate_);
  half_step_ = particles_.concentration;
  for (const std::uint32_t i : liquid_) {
    half_step_[i] += 0.5 * dt * rate_[i];
  }
  fill_species_records(half_step_);
  diffuse(species_records_, neighbours_.list(), species_kernel_, model_.species_factor, liquid_,
          rate_);
  for (const std::uint32_t i : liquid_) {
    if (model_.species_scheme == SpeciesScheme::midpoint) {
      particles_.concentration[i] += dt * rate_[i];
    } else {
      particles_.concentration[i] = half_step_[i] + 0.5 * dt * rate_[i];
    }
  }
}

/// Times of melting and freezing, and how fast and steeply the melt froze.
void Engine::note_phase_times(std::size_t i, double old_enthalpy, double old_temperature,
                              double dt) {
  const double concentration = particles_.concentration[i];
  const double liquidus = mixture_.liquidus(concentration);
  const double before = old_temperature, now = particles_.temperature[i];
  if ((before >= liquidus) == (now >= liquidus) || dt <= 0) {
    return;
  }
  // Enthalpy changes evenly within a step, temperature does not.
  const double crossing = mixture_.enthalpy(liquidus, concentration);
  const double change = particles_.enthalpy[i] - old_enthalpy;
  const double share = change != 0 ? std::clamp((crossing - old_enthalpy) / change, 0.0, 1.0) : 1;
  const double when = time_ + share * dt;
  if (now >= liquidus) {
    particles_.melt_time[i] = when;
    return;
  }
  particles_.freeze_time[i] = when;
  // The rate at which the liquid cooled, before the latent heat held it.
  particles_.cooling_rate[i] =
      -change / dt / mixture_.specific_heat(liquidus + 1e-6, concentration);
  InterfaceSums sums;
  const HeatRecord& own = heat_records_[i];
  const NeighbourList& list = neighbours_.list();
  for (std::size_t k = list.first[i]; k < list.last[i]; ++k) {
    const std::uint32_t j = list.index[k];
    const HeatRecord& other = heat_records_[j];
    const double x = own.x - other.x, y = own.y - other.y, z = own.z - other.z;
    if (j == list.void_index || other.volume == 0) {
      continue;
    }
    const double factor = kernel_.gradient_factor(x * x + y * y + z * z);
    const double step = factor * (own.temperature - other.temperature);
    sums.difference[0] += step * x;
    sums.difference[1] += step * y;
    sums.difference[2] += step * z;
    sums.moment[0] += factor * x * x;
    sums.moment[1] += factor * y * y;
    sums.moment[2] += factor * z * z;
    sums.moment[3] += factor * x * y;
    sums.moment[4] += factor * x * z;
    sums.moment[5] += factor * y * z;
  }
  const Vector gradient = surface_gradient(sums, {});
  particles_.freeze_gradient[i] = std::hypot(gradient[0], gradient[1], gradient[2]);
}

/// Evaporation, radiation and convection into source_. A flowing surface evaporates from all of its
/// area, seen from above or not; what stands still loses heat through its plan area.
/// @returns the fastest rate, 1/s.
double Engine::lose_surface_heat() {
  loss_ = {};
  std::fill(source_.begin(), source_.end(), 0.0);
  if (!model_.surface_loss) {
    return 0;
  }
  if (flow_) {
    std::fill(loss_area_.begin(), loss_area_.end(), 0.0);
    for (const std::uint32_t top : surface_.top) {
      if (top != SurfaceColumns::none && particles_.phase[top] == Phase::solid) {
        loss_area_[top] += surface_.width * surface_.width;
      }
    }
    for (const std::uint32_t i : flow_->liquid()) {
      loss_area_[i] = flow_->area()[i];
    }
    loss_ = lose_heat(particles_, loss_area_, mixture_, *model_.surface_loss, source_);
  } else {
    loss_ = lose_heat(particles_, surface_, mixture_, *model_.surface_loss, source_);
  }
  return loss_.fastest_rate;
}

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
  for_each_particle(n, [&](std::size_t i) {
    note_phase_times(i, old_enthalpy_[i], old_temperature_[i], dt);
  });
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/step/engine.hpp"

#include <algorithm>
#include <cmath>
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

}  // namespace

Engine::Engine(Particles particles, Mixture mixture, Diffusivity diffusivity, const Model& model)
    : particles_(sorted(std::move(particles), model.smoothing_ratio)),
      mixture_(std::move(mixture)),
      diffusivity_law_(std::move(diffusivity)),
      model_(model),
      kernel_(lattice_kernel(particles_, model.smoothing_ratio, model.heat_moments)),
      species_kernel_(lattice_kernel(particles_, model.smoothing_ratio, model.species_moments)),
      ghosts_(make_ghosts(particles_, model.domain, kernel_.support())),
      neighbours_(make_neighbours(particles_, ghosts_, kernel_.support())) {
  const std::size_t n = particles_.size(), with_ghosts = n + ghosts_.size() + 1;
  heat_records_.resize(with_ghosts);
  species_records_.resize(with_ghosts);
  for (auto* field :
       {&thermal_diffusivity_, &diffusivity_, &conducted_, &source_, &rate_, &absorptivity_}) {
    field->assign(n, 0.0);
  }
  if (model_.laser || model_.surface_loss) {
    surface_ = find_surface(particles_, model_.domain.lower, model_.domain.upper);
  }
  // Positions and volumes of the records are those of fixed particles, so they are written once.
  const auto place = [&](std::size_t at, std::size_t source, const Vector& position) {
    const double volume = particles_.volume[source];
    heat_records_[at] = {position[0], position[1], position[2], volume, 0, 1};
    species_records_[at] = {
        position[0], position[1], position[2], volume, particles_.mass[source] / volume, 0, 0};
  };
  for (std::size_t i = 0; i < n; ++i) {
    place(i, i, particles_.position[i]);
  }
  for (std::size_t g = 0; g < ghosts_.size(); ++g) {
    place(n + g, ghosts_[g].source, ghosts_[g].position);
  }
  for_each_particle(n, [&](std::size_t i) { refresh(i); });
  refresh_ghosts();
  check_numbers();
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
  diffusivity_[i] = liquid > 0 ? liquid * diffusivity_law_(temperature) : 0;
  absorptivity_[i] = mixture_.absorptivity(concentration);
  heat_records_[i].temperature = temperature;
  heat_records_[i].conductivity = conductivity;
}

void Engine::refresh_ghosts() {
  const std::size_t n = particles_.size();
  for_each_particle(ghosts_.size(), [&](std::size_t g) {
    const Ghost& ghost = ghosts_[g];
    heat_records_[n + g].temperature =
        ghost.sign * particles_.temperature[ghost.source] + ghost.offset;
    heat_records_[n + g].conductivity = heat_records_[ghost.source].conductivity;
  });
}

void Engine::check_numbers() const {
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    if (!std::isfinite(particles_.temperature[i])) {
      const auto& at = particles_.position[i];
      throw std::runtime_error(fmt::format(
          "step {}, time {:.6g} s: the temperature of particle {} at ({:.3g}, {:.3g}, {:.3g}) um "
          "is not a number "
          "(enthalpy {:.6g} J/kg, concentration {:.6g}; last conducted power {:.6g} W/m3, source "
          "{:.6g} W)",
          steps_, time_, particles_.identity[i], 1e6 * at[0], 1e6 * at[1], 1e6 * at[2],
          particles_.enthalpy[i], particles_.concentration[i], conducted_[i], source_[i]));
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
  diffuse(species_records_, neighbours_, species_kernel_, model_.species_factor, liquid_, rate_);
  half_step_ = particles_.concentration;
  for (const std::uint32_t i : liquid_) {
    half_step_[i] += 0.5 * dt * rate_[i];
  }
  fill_species_records(half_step_);
  diffuse(species_records_, neighbours_, species_kernel_, model_.species_factor, liquid_, rate_);
  for (const std::uint32_t i : liquid_) {
    if (model_.species_scheme == SpeciesScheme::midpoint) {
      particles_.concentration[i] += dt * rate_[i];
    } else {
      particles_.concentration[i] = half_step_[i] + 0.5 * dt * rate_[i];
    }
  }
}

double Engine::step(double until) {
  const std::size_t n = particles_.size();
  // The state belongs to the present enthalpy and concentration: the constructor and the end of
  // each step see to that.
  StepExtremes extremes;
  extremes.smoothing_length = kernel_.smoothing_length;
  if (model_.conduction) {
    extremes.thermal_diffusivity =
        block_max(n, 0.0, [&](std::size_t i) { return thermal_diffusivity_[i]; });
  }
  if (model_.species) {
    extremes.species_diffusivity =
        block_max(n, 0.0, [&](std::size_t i) { return diffusivity_[i]; });
  }
  std::fill(source_.begin(), source_.end(), 0.0);
  SurfaceLossBudget loss;
  if (model_.surface_loss) {
    loss = lose_heat(particles_, surface_, mixture_, *model_.surface_loss, source_);
    extremes.surface_rate = loss.fastest_rate;
  }
  limits_ = step_limits(extremes);
  double end = until;
  if (model_.laser && model_.laser->on(time_)) {
    // The beam is switched off exactly at the end of a step, so that its energy is P times its
    // exposure.
    end = std::min(end, model_.laser->exposure);
  }
  double dt = model_.step_factor * limits_.smallest();
  // A remainder much shorter than a step is shared with the step before it.
  if (time_ + dt >= end) {
    dt = end - time_;
  } else if (time_ + 2 * dt > end) {
    dt = (end - time_) / 2;
  }

  beam_ = {};
  if (model_.laser) {
    // The beam stands where it is in the middle of the step.
    beam_ = model_.laser->on(time_)
                ? irradiate(*model_.laser, time_ + dt / 2, surface_, absorptivity_, source_)
                : LaserBudget{};
  }
  if (model_.conduction) {
    conduct(heat_records_, neighbours_, kernel_, conducted_);
  }
  if (model_.species) {
    advance_species(dt);
  }
  for_each_particle(n, [&](std::size_t i) {
    particles_.enthalpy[i] +=
        dt * (conducted_[i] * particles_.volume[i] + source_[i]) / particles_.mass[i];
    refresh(i);
  });
  refresh_ghosts();
  ledger_.absorbed += dt * beam_.absorbed;
  ledger_.reflected += dt * beam_.reflected;
  ledger_.missed += dt * beam_.missed;
  ledger_.evaporated += dt * loss.evaporation;
  ledger_.radiated += dt * loss.radiation;
  time_ = dt == end - time_ ? end : time_ + dt;
  ++steps_;
  check_numbers();
  return dt;
}

}  // namespace meltproof::solver

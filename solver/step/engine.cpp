// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/step/engine.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "solver/particles/loops.hpp"

namespace meltproof::solver {
namespace {

/// A step that heat holds back changes no temperature by more, K.
constexpr double most_in_a_step = 100;

Particles sorted(Particles particles, double smoothing_ratio) {
  sort_in_space(particles, 3 * smoothing_ratio * particles.spacing);
  return particles;
}

}  // namespace

Engine::Engine(Particles particles, Mixture mixture, Diffusivity diffusivity, const Model& model,
               const Ranks& ranks)
    : particles_(sorted(std::move(particles), model.smoothing_ratio)),
      mixture_(std::move(mixture)),
      diffusivity_law_(std::move(diffusivity)),
      model_(model),
      kernel_(lattice_kernel(particles_.spacing, model.smoothing_ratio, particles_.dimensions,
                             model.heat_moments)),
      species_kernel_(lattice_kernel(particles_.spacing, model.smoothing_ratio,
                                     particles_.dimensions, model.species_moments)),
      halo_(std::make_unique<Halo>(ranks)),
      decomposition_(ranks),
      neighbours_(kernel_.support(), model.flow ? model.flow->skin * particles_.spacing : 0) {
  // Without sleep no temperature is the start's, and everybody is awake.
  start_temperature_ =
      model_.sleep_below > 0 && particles_.size() > 0
          ? mixture_.temperature(particles_.enthalpy[0], particles_.concentration[0])
          : -1e9;
  mobile_.assign(particles_.size(), 0);
  if (!ranks.alone()) {
    check_ranks();
    divide(particles_.position);
  }
  prepare();
  for_each_particle(particles_.size(), [&](std::size_t i) { refresh(i); });
  refresh_ghosts();
  look_from_above();
  check_numbers();
  if (flow_) {
    start_flow();
  }
}

/// What the beam meets, and what loses heat through its plan area.
void Engine::look_from_above() {
  if (model_.laser || model_.surface_loss) {
    surface_ = surface_search_.find(particles_, model_.domain.lower, model_.domain.upper,
                                    model_.laser ? model_.laser->slant() : Slant{}, ranks());
    surface_search_.moves(movers_);
  }
}

/// Fields, lists and records for the particles as they stand.
void Engine::prepare() {
  for (auto* field : {&thermal_diffusivity_, &diffusivity_, &conducted_, &source_}) {
    field->assign(particles_.size(), 0.0);
  }
  // At fine spacings heat, whose steps shorten as h^2, would have shorter ones than so many of
  // sound.
  heat_holds_ = false;
  if (may_open_rounds()) {
    const FlowSettings& flow = *model_.flow;
    heat_holds_ = thermal_limit(best_of_base()) <
                  model_.flow_steps * flow.courant * kernel_.smoothing_length / flow.sound_speed;
  }
  best_of_base_ = best_of_base();
  slow_power_.resize(particles_.size(), 0.0);
  pace_.resize(particles_.size(), 0);
  if (model_.flow) {
    flow_.emplace(*model_.flow, kernel_, particles_.spacing, particles_.dimensions, *halo_);
  }
  ghosts_ = make_ghosts(particles_, model_.domain, kernel_.support() + neighbours_.skin());
  neighbours_.build(particles_, ghosts_, mobile_);
  place_records();
  if (model_.surface_conduction) {
    surface_conduction_.update(heat_records_, ghosts_, neighbours_.list(), kernel_);
  }
}

/// Positions and volumes of the records, of everybody: where indices or images have changed.
void Engine::place_records() {
  const std::size_t n = particles_.size(), all = neighbours_.list().void_index + std::size_t{1};
  heat_records_.resize(all);
  for_each_particle(n, [&](std::size_t i) { place_record(i, i, particles_.position[i]); });
  place_images();
  heat_records_.back() = {};
  heat_records_.back().awake = 0;
}

void Engine::place_record(std::size_t at, std::size_t source, const Vector& position) {
  HeatRecord& heat = heat_records_[at];
  if (particles_.phase[source] == Phase::lost || particles_.home[source] == Home::nowhere) {
    heat = {};
    return;
  }
  heat.x = position[0];
  heat.y = position[1];
  heat.z = position[2];
  heat.volume = particles_.volume[source];
}

void Engine::place_images() {
  const std::size_t n = particles_.size();
  for (std::size_t g = 0; g < ghosts_.size(); ++g) {
    const std::uint32_t source = ghosts_[g].source;
    place_record(n + g, source, ghosts_[g].image_of(particles_.position[source]));
  }
}

/// The same of those who may have moved, or been lost, since the lists were made.
void Engine::place_moving_records() {
  for_each_particle(movers_.size(), [&](std::size_t k) {
    place_record(movers_[k], movers_[k], particles_.position[movers_[k]]);
  });
  place_images();
}

double Engine::total_of(const std::vector<double>& specific) const {
  ExactSum sum = exact_sum(particles_.size(), [&](std::size_t i) {
    return particles_.home[i] == Home::here ? particles_.mass[i] * specific[i] : 0.0;
  });
  ranks().add(sum);
  return sum.total();
}

double Engine::total_enthalpy() const { return total_of(particles_.enthalpy); }

double Engine::total_additive_mass() const { return total_of(particles_.concentration); }

/// The specific heat by which steps are chosen, J kg-1 K-1. Where heat does not hold them back it
/// is taken from a wide range, which costs little there; what was computed so keeps its bits.
double Engine::stable_specific_heat(double temperature, double concentration) const {
  return heat_holds_
             ? mixture_.smallest_specific_heat_within(most_in_a_step, temperature, concentration)
             : mixture_.smallest_specific_heat_near(temperature, concentration);
}

/// The largest k/(rho c_p) of the base alloy below its boiling point, m2 s-1. What conducts better
/// is unmixed grains of a better conductor, and the little melt that the beam boils.
double Engine::best_of_base() const {
  double best = 0;
  for (double t = 298; t < mixture_.boiling(0); ++t) {
    best = std::max(best, mixture_.conductivity(t, 0) / stable_specific_heat(t, 0));
  }
  return best / mixture_.density(0);
}

/// Everything that follows from a particle's enthalpy and concentration, its record included.
void Engine::refresh(std::size_t i) {
  if (particles_.home[i] == Home::nowhere) {
    return;
  }
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
  thermal_diffusivity_[i] = conductivity * particles_.volume[i] /
                            (particles_.mass[i] * stable_specific_heat(temperature, concentration));
  // The liquid part of a mushy particle diffuses, so D rises continuously from the solidus on.
  // What was lost exchanges nothing any more.
  const bool mixes = liquid > 0 && particles_.phase[i] != Phase::lost;
  diffusivity_[i] = mixes ? liquid * diffusivity_law_(temperature) : 0;
  heat_records_[i].temperature = temperature;
  heat_records_[i].conductivity = conductivity;
  heat_records_[i].pace = pace_[i];
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
    heat_records_[n + g].pace = heat_records_[ghost.source].pace;
  });
}

void Engine::check_numbers() const {
  const auto where = [&](std::size_t i) {
    const auto& at = particles_.position[i];
    return fmt::format("step {}, time {:.6g} s, particle {} at ({:.3g}, {:.3g}, {:.3g}) um", steps_,
                       time_, particles_.identity[i], 1e6 * at[0], 1e6 * at[1], 1e6 * at[2]);
  };
  const auto bad = [&](std::size_t i) {
    return particles_.home[i] == Home::here && !std::isfinite(particles_.temperature[i]);
  };
  const bool any =
      block_max(particles_.size(), 0, [&](std::size_t i) { return bad(i) ? 1.0 : 0.0; }) > 0;
  for (std::size_t i = 0; any && i < particles_.size(); ++i) {
    if (bad(i)) {
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
                        flow_->diagnose(particles_, i)));
      }
    }
  }
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// What happens to heat and additive within a thermal step, the laser and conduction apart.
#include <algorithm>
#include <cmath>

#include "solver/step/engine.hpp"

namespace meltproof::solver {

/// Writes the liquid particles, copies included, and their images; those that were liquid before
/// and no longer are get no diffusivity, and the others never had one.
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
    if (diffusivity_[i] > 0 && particles_.home[i] != Home::nowhere) {
      liquid_.push_back(i);
    }
  }
  if (!ranks().any(!liquid_.empty())) {
    return;
  }
  std::vector<std::uint32_t> own;
  std::copy_if(liquid_.begin(), liquid_.end(), std::back_inserter(own),
               [&](std::uint32_t i) { return particles_.home[i] == Home::here; });
  fill_species_records(particles_.concentration);
  diffuse(species_records_, neighbours_.list(), species_kernel_, model_.species_factor, own, rate_);
  half_step_ = particles_.concentration;
  for (const std::uint32_t i : own) {
    half_step_[i] += 0.5 * dt * rate_[i];
  }
  halo_->exchange(
      Halo::everybody, 1, [&](std::uint32_t i, double* out) { *out = half_step_[i]; },
      [&](std::uint32_t i, const double* in) { half_step_[i] = *in; });
  fill_species_records(half_step_);
  diffuse(species_records_, neighbours_.list(), species_kernel_, model_.species_factor, own, rate_);
  for (const std::uint32_t i : own) {
    if (model_.species_scheme == SpeciesScheme::midpoint) {
      particles_.concentration[i] += dt * rate_[i];
    } else {
      particles_.concentration[i] = half_step_[i] + 0.5 * dt * rate_[i];
    }
  }
}

/// Times of melting and freezing, and how fast and steeply the melt froze.
void Engine::note_phase_times(const Crossing& c) {
  if (c.size <= 0) {
    return;
  }
  const std::uint32_t i = c.particle;
  const double concentration = particles_.concentration[i];
  const double liquidus = mixture_.liquidus(concentration);
  const double now = particles_.temperature[i];
  // Enthalpy changes evenly within a step, temperature does not.
  const double crossing = mixture_.enthalpy(liquidus, concentration);
  const double change = particles_.enthalpy[i] - c.old_enthalpy;
  const double share = change != 0 ? std::clamp((crossing - c.old_enthalpy) / change, 0.0, 1.0) : 1;
  const double when = c.begin + share * c.size;
  if (now >= liquidus) {
    particles_.melt_time[i] = when;
    return;
  }
  particles_.freeze_time[i] = when;
  // The rate at which the liquid cooled, before the latent heat held it.
  particles_.cooling_rate[i] =
      -change / c.size / mixture_.specific_heat(liquidus + 1e-6, concentration);
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
      if (top < particles_.size() && particles_.phase[top] == Phase::solid) {
        loss_area_[top] += surface_.width * surface_.width;
      }
    }
    for (const std::uint32_t i : flow_->liquid()) {
      loss_area_[i] = flow_->area(i);
    }
    loss_ = lose_heat(particles_, loss_area_, mixture_, *model_.surface_loss, source_, ranks());
  } else {
    loss_ = lose_heat(particles_, surface_, mixture_, *model_.surface_loss, source_, ranks());
  }
  return loss_.fastest_rate;
}

}  // namespace meltproof::solver

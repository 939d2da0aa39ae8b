// SPDX-License-Identifier: GPL-3.0-or-later
// What happens to heat and additive within a thermal step, the laser and conduction apart.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "solver/particles/loops.hpp"
#include "solver/step/engine.hpp"

namespace meltproof::solver {

/// Records of what diffuses, copies and images included. @param concentration of liquid_, in that
/// order.
void Engine::fill_species_records(const std::vector<double>& concentration) {
  const std::size_t n = particles_.size(), all = neighbours_.list().void_index + std::size_t{1};
  SpeciesRecords& species = species_records_;
  species.records.clear();
  const auto record = [&](const Vector& at, std::uint32_t i, double c) {
    const double volume = particles_.volume[i];
    species.records.push_back(
        {at[0], at[1], at[2], volume, particles_.mass[i] / volume, c, diffusivity_[i]});
  };
  for (std::size_t k = 0; k < liquid_.size(); ++k) {
    record(particles_.position[liquid_[k]], liquid_[k], concentration[k]);
  }
  // Where each stands among them; all others exchange nothing, as the void does.
  const auto none = static_cast<std::uint32_t>(liquid_.size() + ghosts_.size());
  species.place.assign(all, none);
  for (std::uint32_t k = 0; k < liquid_.size(); ++k) {
    species.place[liquid_[k]] = k;
  }
  for (std::size_t g = 0; g < ghosts_.size(); ++g) {
    const std::uint32_t source = ghosts_[g].source, place = species.place[source];
    if (place == none) {
      species.records.emplace_back();
    } else {
      record(ghosts_[g].image_of(particles_.position[source]), source, concentration[place]);
      species.place[n + g] = static_cast<std::uint32_t>(species.records.size() - 1);
    }
  }
  species.records.emplace_back();
}

void Engine::advance_species(double dt) {
  // Only liquid particles exchange: D is zero in the solid, and the pair term with it.
  select_indices(
      particles_.size(),
      [&](std::uint32_t i) { return diffusivity_[i] > 0 && particles_.home[i] != Home::nowhere; },
      liquid_);
  if (!ranks().any(!liquid_.empty())) {
    return;
  }
  std::vector<std::uint32_t> own;
  std::vector<double> concentration, rate;
  for (const std::uint32_t i : liquid_) {
    concentration.push_back(particles_.concentration[i]);
    if (particles_.home[i] == Home::here) {
      own.push_back(i);
    }
  }
  const auto exchange = [&] {
    fill_species_records(concentration);
    diffuse(species_records_, neighbours_.list(), species_kernel_, model_.species_factor, own,
            rate);
  };
  const auto place = [&](std::uint32_t i) { return species_records_.place[i]; };
  exchange();
  for (std::size_t k = 0; k < own.size(); ++k) {
    concentration[place(own[k])] += 0.5 * dt * rate[k];
  }
  halo_->exchange(
      Halo::everybody, 1,
      [&](std::uint32_t i, double* out) {
        *out = place(i) < concentration.size() ? concentration[place(i)] : 0;
      },
      [&](std::uint32_t i, const double* in) {
        if (place(i) < concentration.size()) {
          concentration[place(i)] = *in;
        }
      });
  exchange();
  for (std::size_t k = 0; k < own.size(); ++k) {
    const std::uint32_t i = own[k];
    if (model_.species_scheme == SpeciesScheme::midpoint) {
      particles_.concentration[i] += dt * rate[k];
    } else {
      particles_.concentration[i] = concentration[place(i)] + 0.5 * dt * rate[k];
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
  neighbours_.list().each(i, [&](std::uint32_t j) {
    const HeatRecord& other = heat_records_[j];
    const double x = own.x - other.x, y = own.y - other.y, z = own.z - other.z;
    if (other.volume == 0) {
      return;
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
  });
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
    std::vector<std::uint32_t> tops;
    std::vector<std::uint8_t> columns(particles_.size(), 0);  // that a particle is on top of: <= 4
    for (const std::uint32_t top : surface_.top) {
      if (top < particles_.size() && particles_.phase[top] == Phase::solid && columns[top]++ == 0) {
        tops.push_back(top);
      }
    }
    std::sort(tops.begin(), tops.end());
    std::vector<ExposedArea> areas;
    for (const std::uint32_t top : tops) {
      areas.push_back({top, 0});
      for (int column = 0; column < columns[top]; ++column) {
        areas.back().area += surface_.width * surface_.width;
      }
    }
    for (const std::uint32_t i : flow_->liquid()) {
      if (const double area = flow_->area(i); area > 0) {
        areas.push_back({i, area});
      }
    }
    loss_ = lose_heat(particles_, areas, mixture_, *model_.surface_loss, source_, ranks());
  } else {
    loss_ = lose_heat(particles_, surface_, mixture_, *model_.surface_loss, source_, ranks());
  }
  return loss_.fastest_rate;
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// What melts, freezes, or leaves the domain.
#include "solver/particles/loops.hpp"
#include "solver/step/engine.hpp"

namespace meltproof::solver {

/// Melts and freezes; takes out what left the domain. @returns whether any phase changed.
bool Engine::change_phases() {
  const std::size_t n = particles_.size();
  const PackedLists& list = neighbours_.list();
  const double touch = 2.25 * particles_.spacing * particles_.spacing;
  std::vector<std::uint32_t> crossing, freezing;
  bool changed = false;
  select_indices(
      n,
      [&](std::uint32_t i) {
        const Phase phase = particles_.phase[i];
        const double fraction = particles_.liquid_fraction[i];
        return particles_.home[i] == Home::here &&
               ((phase == Phase::solid && fraction >= 1) ||
                (phase == Phase::liquid && fraction < model_.freezing_fraction));
      },
      crossing);
  for (const std::uint32_t i : crossing) {
    if (particles_.phase[i] == Phase::solid) {
      particles_.phase[i] = Phase::liquid;
      particles_.velocity[i] = {};
      particles_.density[i] = particles_.mass[i] / particles_.volume[i];
      changed = true;
    } else {
      freezing.push_back(i);
    }
  }
  // A drop in flight that cools stays in flight: melt freezes to something that stands still. What
  // freezes in this step does not count for the others, so that their order does not matter.
  std::vector<std::uint8_t> touches(freezing.size(), 0);
  for (std::size_t f = 0; f < freezing.size(); ++f) {
    const Vector& at = particles_.position[freezing[f]];
    list.each(freezing[f], [&](std::uint32_t j) {
      // A copy of what melts in this step is told of it only afterwards.
      const bool melts =
          j < n && particles_.home[j] == Home::elsewhere && particles_.liquid_fraction[j] >= 1;
      if (j < n && particles_.phase[j] == Phase::solid && !melts) {
        const Vector& other = particles_.position[j];
        const double x = at[0] - other[0], y = at[1] - other[1], z = at[2] - other[2];
        touches[f] = touches[f] != 0 || x * x + y * y + z * z < touch ? 1 : 0;
      }
    });
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
  std::uint64_t lost_here = 0;
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
      ++lost_here;
      changed = true;
    }
  }
  if (!ranks().alone()) {
    copy_phases();
    changed = ranks().any(changed);
    lost_here = changed ? ranks().add(lost_here) : 0;
  }
  lost_ += lost_here;
  return changed;
}

/// Copies melt, freeze and get lost with those whose copies they are.
void Engine::copy_phases() {
  halo_->exchange(
      Halo::everybody, 1,
      [&](std::uint32_t i, double* out) { *out = static_cast<double>(particles_.phase[i]); },
      [&](std::uint32_t i, const double* in) {
        const auto phase = static_cast<Phase>(static_cast<std::uint8_t>(*in));
        if (phase == particles_.phase[i]) {
          return;
        }
        particles_.phase[i] = phase;
        particles_.velocity[i] = {};
        if (phase == Phase::lost) {
          diffusivity_[i] = 0;
        } else {
          particles_.density[i] = particles_.mass[i] / particles_.volume[i];
        }
      });
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// Heat in two paces: near the melt with every thermal step, elsewhere once in a round of them.
#include <algorithm>
#include <cmath>

#include "solver/particles/loops.hpp"
#include "solver/step/engine.hpp"

namespace meltproof::solver {
namespace {

/// Metal that the beam or its surface's losses would change by more than this within a round takes
/// every step, J kg-1: some 10 K of steel.
constexpr double slow_change = 5e3;

}  // namespace

/// Into conducted_: what everybody gains by conduction in this step, W m-3.
///
/// What the flow allows is a tenth of the step that conduction would need, so most of the metal
/// takes that longer one: in a **round** of steps, two slow particles exchange heat once, at its
/// start, by as much as flows in the whole round, and have it at its end. A fast particle exchanges
/// with all its neighbours in every step; a slow one beside it takes part in that, and only in
/// that. So each pair is counted by both of its particles in the same steps with the same
/// temperatures, and energy stays exact.
/// @param longest of a round, s.
void Engine::exchange_heat(double dt, double longest) {
  const PackedLists& list = neighbours_.list();
  bool opened = false;
  if (!round_open_) {
    find_awake(heat_records_, list, heat_active_);
    if (!ranks().alone()) {
      std::erase_if(heat_active_,
                    [&](std::uint32_t i) { return particles_.home[i] != Home::here; });
    }
    conduct(heat_records_, list, kernel_, heat_active_, conducted_);
    heat_evaluations_ += heat_active_.size();
    if (model_.surface_conduction) {
      surface_conduction_.add(heat_records_, list, kernel_, heat_active_, conducted_);
    }
    if (!flow_ || !model_.multirate || model_.surface_conduction || 2 * dt > longest) {
      return;
    }
    open_round(longest);
    opened = true;
  }
  if (boundary_stale_) {
    find_boundary();
  }
  if (!opened) {
    conduct(heat_records_, list, kernel_, heat_active_, conducted_);
    heat_evaluations_ += heat_active_.size();
  }
  heat_evaluations_ += boundary_.size();
  conduct_apart(heat_records_, list, kernel_, boundary_, conducted_,
                opened ? &slow_power_ : nullptr);
  round_time_ += dt;
  // Neither a round nor its flags outlive a sort.
  round_closes_ = round_time_ + dt > longest || sort_due_;
  if (round_closes_) {
    for_each_particle(particles_.size(), [&](std::size_t i) {
      conducted_[i] += slow_power_[i] * (round_time_ / dt);
      slow_power_[i] = 0;
    });
  }
}

/// Who is fast: what has moving metal near it, or is heated or cooled quickly at its surface. The
/// others keep the power that
/// they exchange among themselves until the round closes.
void Engine::open_round(double longest) {
  std::fill(fast_.begin(), fast_.end(), std::uint8_t{0});
  for (const std::uint32_t i : neighbours_.near_moving()) {
    fast_[i] = particles_.home[i] == Home::here ? 1 : 0;
  }
  for_each_particle(heat_active_.size(), [&](std::size_t k) {
    const std::uint32_t i = heat_active_[k];
    if (std::abs(source_[i]) * longest > slow_change * particles_.mass[i]) {
      fast_[i] = 1;
    }
    if (fast_[i] == 0) {
      slow_power_[i] = conducted_[i];
      conducted_[i] = 0;
    }
  });
  halo_->exchange(
      Halo::everybody, 1, [&](std::uint32_t i, double* out) { *out = fast_[i]; },
      [&](std::uint32_t i, const double* in) { fast_[i] = *in > 0 ? 1 : 0; });
  for_each_particle(particles_.size(), [&](std::size_t i) { heat_records_[i].fast = fast_[i]; });
  refresh_ghosts();
  round_time_ = 0;
  round_open_ = boundary_stale_ = true;
}

/// The fast particles of this rank, into heat_active_, and the slow ones beside fast ones.
void Engine::find_boundary() {
  const PackedLists& list = neighbours_.list();
  const std::size_t n = particles_.size();
  std::vector<std::uint8_t> beside(n, 0);
  heat_active_.clear();
  for (std::uint32_t i = 0; i < n; ++i) {
    if (fast_[i] != 0 && particles_.home[i] == Home::here) {
      heat_active_.push_back(i);
    }
  }
  for_each_particle(heat_active_.size(), [&](std::size_t a) {
    list.each(heat_active_[a], [&](std::uint32_t j) {
      const std::uint32_t source = j < n ? j : ghosts_[j - n].source;
      // Fast ones among them, too, and left out below: no branch to be guessed wrong.
#pragma omp atomic write
      beside[source] = 1;
    });
  });
  halo_->give_back(
      Halo::everybody, 1, [&](std::uint32_t i, double* out) { *out = beside[i]; },
      [&](std::uint32_t i, const double* in) {
        if (*in > 0) {
          beside[i] = 1;
        }
      });
  boundary_.clear();
  for (std::uint32_t i = 0; i < n; ++i) {
    if (beside[i] != 0 && fast_[i] == 0 && particles_.home[i] == Home::here) {
      boundary_.push_back(i);
    }
  }
  boundary_stale_ = false;
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// Heat in three paces: near the melt with every thermal step, elsewhere once in a round of them,
// and what conducts best in parts of one.
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
/// that. Where a few particles conduct so much better than the rest that they would hold every step
/// back, as grains of aluminium in steel do at fine spacings, those and their neighbours exchange
/// in
/// **substeps** of it. So each pair is counted by both of its particles at the same times with the
/// same temperatures, and energy stays exact.
void Engine::exchange_heat(const Step& step) {
  const PackedLists& list = neighbours_.list();
  const double dt = step.size;
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
    if (!may_open_rounds() || (step.heat_substeps == 0 && 2 * dt > step.round)) {
      return;
    }
    open_round(step);
    opened = true;
  }
  if (boundary_stale_) {
    find_boundary();
  }
  if (step.heat_substeps > 0) {
    if (!opened) {
      std::fill(conducted_.begin(), conducted_.end(), 0.0);
    }
    std::vector<double> power(heat_active_.size());
    conduct_with(heat_records_, list, kernel_, heat_active_, pace::slow, pace::every_step,
                 power.data());
    for (std::size_t k = 0; k < heat_active_.size(); ++k) {
      conducted_[heat_active_[k]] = power[k];
    }
    heat_evaluations_ += heat_active_.size();
  } else if (!opened) {
    conduct(heat_records_, list, kernel_, heat_active_, conducted_);
    heat_evaluations_ += heat_active_.size();
  }
  heat_evaluations_ += boundary_.size();
  conduct_apart(heat_records_, list, kernel_, boundary_, conducted_,
                opened ? &slow_power_ : nullptr);
  if (step.heat_substeps > 0) {
    exchange_in_substeps(dt, step.heat_substeps);
  }
  round_time_ += dt;
  // Neither a round nor its paces outlive a sort.
  round_closes_ = round_time_ + dt > step.round || sort_due_;
  if (round_closes_) {
    for_each_particle(particles_.size(), [&](std::size_t i) {
      conducted_[i] += slow_power_[i] * (round_time_ / dt);
      slow_power_[i] = 0;
    });
  }
}

/// Whether heat may be exchanged in rounds of steps at all.
bool Engine::may_open_rounds() const {
  return model_.flow && model_.multirate && !model_.surface_conduction;
}

/// Who takes which pace. Fast is what has moving metal near it, or is heated or cooled quickly at
/// its surface. The slow keep the power that they exchange among themselves until the round closes.
void Engine::open_round(const Step& step) {
  std::fill(pace_.begin(), pace_.end(), pace::slow);
  if (step.heat_substeps > 0) {
    // Those that nothing has warmed yet sleep through the round, even if it warms something beside
    // them: far from the beam there are many of them.
    for_each_particle(particles_.size(), [&](std::size_t i) {
      if (particles_.home[i] == Home::here && thermal_diffusivity_[i] > best_of_base_) {
        pace_[i] = pace::asleep;
      }
    });
  }
  for (const std::uint32_t i : neighbours_.near_moving()) {
    if (particles_.home[i] == Home::here && pace_[i] == pace::slow) {
      pace_[i] = pace::every_step;
    }
  }
  for_each_particle(heat_active_.size(), [&](std::size_t k) {
    const std::uint32_t i = heat_active_[k];
    if (pace_[i] == pace::asleep) {
      pace_[i] = pace::substeps;
    } else if (std::abs(source_[i]) * step.round > slow_change * particles_.mass[i]) {
      pace_[i] = pace::every_step;
    }
    if (pace_[i] == pace::slow) {
      slow_power_[i] = conducted_[i];
      conducted_[i] = 0;
    } else if (pace_[i] == pace::substeps) {
      conducted_[i] = 0;
    }
  });
  halo_->exchange(
      Halo::everybody, 1, [&](std::uint32_t i, double* out) { *out = pace_[i]; },
      [&](std::uint32_t i, const double* in) { pace_[i] = static_cast<std::uint8_t>(*in); });
  for_each_particle(particles_.size(), [&](std::size_t i) { heat_records_[i].pace = pace_[i]; });
  refresh_ghosts();
  round_time_ = 0;
  round_open_ = boundary_stale_ = true;
}

/// The fast particles of this rank, into heat_active_, those that take substeps, into substeppers_,
/// the slow ones beside either, and all that exchange with those in substeps.
void Engine::find_boundary() {
  const PackedLists& list = neighbours_.list();
  const std::size_t n = particles_.size();
  std::vector<std::uint8_t> beside(n, 0), beside_substeps;
  heat_active_.clear();
  substeppers_.clear();
  for (std::uint32_t i = 0; i < n; ++i) {
    if (pace_[i] != pace::slow && particles_.home[i] == Home::here) {
      if (pace_[i] == pace::every_step) {
        heat_active_.push_back(i);
      } else if (pace_[i] == pace::substeps) {
        substeppers_.push_back(i);
      }
    }
  }
  const auto mark = [&](const std::vector<std::uint32_t>& members,
                        std::vector<std::uint8_t>& marks) {
    for_each_particle(members.size(), [&](std::size_t a) {
      list.each(members[a], [&](std::uint32_t j) {
        const std::uint32_t source = j < n ? j : ghosts_[j - n].source;
        // Fast ones among them, too, and left out below: no branch to be guessed wrong.
#pragma omp atomic write
        marks[source] = 1;
      });
    });
    halo_->give_back(
        Halo::everybody, 1, [&](std::uint32_t i, double* out) { *out = marks[i]; },
        [&](std::uint32_t i, const double* in) {
          if (*in > 0) {
            marks[i] = 1;
          }
        });
  };
  beside_substeppers_.clear();
  if (ranks().any(!substeppers_.empty())) {
    beside_substeps.assign(n, 0);
    mark(substeppers_, beside_substeps);
    beside = beside_substeps;
  }
  mark(heat_active_, beside);
  boundary_.clear();
  for (std::uint32_t i = 0; i < n; ++i) {
    if (beside[i] == 0 || particles_.home[i] != Home::here) {
      continue;
    }
    if (pace_[i] == pace::slow) {
      boundary_.push_back(i);
    }
    if (!beside_substeps.empty() && beside_substeps[i] != 0 && pace_[i] <= pace::every_step) {
      beside_substeppers_.push_back(i);
    }
  }
  boundary_stale_ = false;
}

/// Adds to conducted_ what goes to and from those that conduct best: in equal parts of a step, from
/// temperatures that follow. What else their neighbours are given in this step comes evenly.
void Engine::exchange_in_substeps(double dt, int parts) {
  const PackedLists& list = neighbours_.list();
  std::vector<std::uint32_t> members = substeppers_;
  members.insert(members.end(), beside_substeppers_.begin(), beside_substeppers_.end());
  std::vector<double> rate(members.size()), gained(members.size(), 0.0);
  // The records hold the temperatures, those of images and copies as well.
  const auto temperatures = [&](const auto& enthalpy_of) {
    for_each_particle(members.size(), [&](std::size_t k) {
      const std::uint32_t i = members[k];
      const double concentration = particles_.concentration[i];
      const double now = mixture_.temperature(enthalpy_of(k, i), concentration);
      heat_records_[i].temperature = now;
      heat_records_[i].conductivity = mixture_.conductivity(now, concentration);
    });
    halo_->exchange(
        Halo::everybody, 2,
        [&](std::uint32_t i, double* out) {
          out[0] = heat_records_[i].temperature;
          out[1] = heat_records_[i].conductivity;
        },
        [&](std::uint32_t i, const double* in) {
          heat_records_[i].temperature = in[0];
          heat_records_[i].conductivity = in[1];
        });
    for (std::size_t g = 0; g < ghosts_.size(); ++g) {
      const Ghost& ghost = ghosts_[g];
      HeatRecord& image = heat_records_[particles_.size() + g];
      image.temperature = ghost.sign * heat_records_[ghost.source].temperature + ghost.offset;
      image.conductivity = heat_records_[ghost.source].conductivity;
    }
  };
  for (int part = 0; part < parts; ++part) {
    if (part > 0) {
      temperatures([&](std::size_t k, std::uint32_t i) {
        const double steady = conducted_[i] * particles_.volume[i] + source_[i];
        return particles_.enthalpy[i] +
               (dt * part / parts * steady + gained[k] * particles_.volume[i]) / particles_.mass[i];
      });
    }
    conduct_with(heat_records_, list, kernel_, substeppers_, pace::slow, pace::substeps,
                 rate.data());
    conduct_with(heat_records_, list, kernel_, beside_substeppers_, pace::substeps, pace::substeps,
                 rate.data() + substeppers_.size());
    heat_evaluations_ += members.size();
    for (std::size_t k = 0; k < members.size(); ++k) {
      gained[k] += dt / parts * rate[k];
    }
  }
  for (std::size_t k = 0; k < members.size(); ++k) {
    conducted_[members[k]] += gained[k] / dt;
  }
  if (parts > 1) {
    temperatures([&](std::size_t, std::uint32_t i) { return particles_.enthalpy[i]; });
  }
}

}  // namespace meltproof::solver

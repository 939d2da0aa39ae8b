// SPDX-License-Identifier: GPL-3.0-or-later
// Work measured and divided among ranks anew as the pool moves.
#include <algorithm>
#include <array>
#include <limits>

#include "solver/step/engine.hpp"

namespace meltproof::solver {

/// What costs what on this rank: all particles, those that conduct, those that flow or bound it.
std::array<std::uint64_t, 3> Engine::workload() const {
  std::array<std::uint64_t, 3> count{};
  count[0] = static_cast<std::uint64_t>(
      std::count(particles_.home.begin(), particles_.home.end(), Home::here));
  count[1] = heat_active_.size();
  count[2] = flow_->liquid().size() + flow_->wall().size();
  return count;
}

/// What one of each costs, s, by how long the parts of the steps since the last measurement took on
/// all ranks together, but for the time that ranks waited for each other.
std::array<double, 3> Engine::unit_costs() {
  const StepTimes &now = times_, &then = times_at_balance_;
  std::array<double, 3> spent{
      now.surface - then.surface + now.state - then.state,
      now.heat - then.heat + now.species - then.species,
      now.flow - then.flow + now.lists - then.lists - (halo_->waited() - waited_at_balance_)};
  times_at_balance_ = times_;
  waited_at_balance_ = halo_->waited();
  std::array<std::uint64_t, 3> count = workload();
  ranks().add(count);
  // Should nothing have been measured yet.
  std::array<double, 3> each{1e-7, 5e-7, 5e-6};
  for (std::size_t k = 0; k < 3; ++k) {
    ExactSum seconds;
    seconds.add(std::max(0.0, spent[k]));
    ranks().add(seconds);
    if (count[k] > 0 && seconds.total() > 0) {
      each[k] = seconds.total() / static_cast<double>(count[k]);
    }
  }
  return each;
}

/// Whether the rank with the most work has so much more than the mean that new boxes pay. Looks at
/// clocks, so it falls out otherwise in every run: nothing that is computed depends on it.
bool Engine::out_of_balance() {
  constexpr double tolerated = 1.15;
  // A division costs about as much as so many rebuilds.
  constexpr std::size_t pause = 24;
  if (++rebuilds_since_division_ < pause) {
    return false;
  }
  rebuilds_since_division_ = 0;
  costs_ = unit_costs();
  const std::array<std::uint64_t, 3> count = workload();
  Decomposition::Cost own{};
  for (std::size_t k = 0; k < 3; ++k) {
    own[k] = costs_[k] * static_cast<double>(count[k]);
  }
  imbalance_ = Decomposition::unevenness(ranks(), own);
  // Where even the last division left as much, another one would, too.
  return imbalance_ > std::max(tolerated, 1.05 * imbalance_after_division_);
}

/// New boxes of equal cost, new owners, new copies. @param sort also a new space-filling order.
void Engine::divide_anew(bool sort) {
  Vector lower;
  lower.fill(std::numeric_limits<double>::infinity());
  std::vector<std::uint8_t> heated(particles_.size(), 0), flows(particles_.size(), 0);
  for (const std::uint32_t i : heat_active_) {
    heated[i] = 1;
  }
  for (const auto* members : {&flow_->liquid(), &flow_->wall()}) {
    for (const std::uint32_t i : *members) {
      flows[i] = 1;
    }
  }
  std::vector<Vector> places;
  std::vector<Decomposition::Cost> costs;
  std::vector<Traveller> own;
  for (std::uint32_t i = 0; i < particles_.size(); ++i) {
    if (particles_.home[i] == Home::here) {
      own.push_back(pack(i));
      places.push_back(particles_.position[i]);
      costs.push_back({costs_[0], heated[i] * costs_[1], flows[i] * costs_[2]});
      for (std::size_t d = 0; d < 3; ++d) {
        lower[d] = std::min(lower[d], particles_.position[i][d]);
      }
    }
  }
  if (sort) {
    ranks().smallest(lower);
    for (Traveller& t : own) {
      t.order = place_in_space(t.position, lower, 3 * kernel_.smoothing_length);
    }
  }
  imbalance_after_division_ = decomposition_.balance(places, costs);
  rebuilds_since_division_ = 0;
  const auto size = static_cast<std::size_t>(ranks().size());
  std::vector<std::vector<Traveller>> to(size), copies(size);
  for (const Traveller& t : own) {
    to[static_cast<std::size_t>(decomposition_.owner(t.position))].push_back(t);
  }
  own = {};  // all of it is in `to`: particles of a rank are many, and this is where most are held
  own = ranks().exchange(to);
  for (Traveller& t : own) {
    t.rank = ranks().rank();
  }
  std::vector<int> near;
  for (const Traveller& t : own) {
    decomposition_.near(t.position, copy_reach(), near);
    for (const int r : near) {
      if (r != ranks().rank()) {
        copies[static_cast<std::size_t>(r)].push_back(t);
      }
    }
  }
  const std::vector<Traveller> others = ranks().exchange(copies);
  own.insert(own.end(), others.begin(), others.end());
  std::sort(own.begin(), own.end(), comes_before);
  particles_.each_array([&](auto& values) { values.assign(own.size(), {}); });
  free_.clear();
  fit_fields();
  flow_->forget();
  for (std::uint32_t i = 0; i < own.size(); ++i) {
    unpack(i, own[i], own[i].rank == ranks().rank() ? Home::here : Home::elsewhere);
    flow_->set_particle(i, own[i].flow);
  }
  note_peers(particles_.position);
  settled_ = particles_.size();
  vacated_.clear();
  add_free_slots();
  for (auto* members : {&heat_active_, &liquid_}) {
    members->clear();
  }
}

}  // namespace meltproof::solver

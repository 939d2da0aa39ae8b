// SPDX-License-Identifier: GPL-3.0-or-later
// Particles that move go to the rank in whose part of space they now are.
#include <algorithm>
#include <iterator>
#include <unordered_map>

#include "solver/step/engine.hpp"

namespace meltproof::solver {

/// Who moves, or did when the lists were last made, goes to the rank in whose box it now is, and
/// its copies to those nearby. All others stand where they stood.
/// @param before mobile_ when the lists were last made, where mobile_ is what it is now.
/// @returns the entries that have come into use or out of it.
Engine::Moved Engine::move_between_ranks(const std::vector<std::uint8_t>& before) {
  const Ranks& ranks = halo_->ranks();
  const auto size = static_cast<std::size_t>(ranks.size());
  const auto unsettled = [&](std::uint32_t i) { return before[i] != 0 || mobile_[i] != 0; };
  Moved moved;
  std::vector<Halo::Peer> peers(size);
  for (const Halo::Peer& old : halo_->peers()) {
    Halo::Peer& kept = peers[static_cast<std::size_t>(old.rank)];
    const auto settled = [&](std::uint32_t i) { return !unsettled(i); };
    std::copy_if(old.send.begin(), old.send.end(), std::back_inserter(kept.send), settled);
    std::copy_if(old.receive.begin(), old.receive.end(), std::back_inserter(kept.receive), settled);
  }
  std::vector<std::uint32_t> stays;
  // Who leaves mostly comes back as a copy, or with its next one: then it gets its entry again, so
  // that indices keep following the order of sums.
  std::unordered_map<std::int64_t, std::uint32_t> left;
  std::vector<std::vector<Traveller>> to(size);
  for (std::uint32_t i = 0; i < particles_.size(); ++i) {
    if (particles_.home[i] == Home::nowhere || !unsettled(i)) {
      continue;
    }
    if (particles_.home[i] == Home::here) {
      const int owner = decomposition_.owner(particles_.position[i]);
      if (owner == ranks.rank()) {
        stays.push_back(i);
        continue;
      }
      to[static_cast<std::size_t>(owner)].push_back(pack(i));
    }
    particles_.home[i] = Home::nowhere;
    particles_.phase[i] = Phase::solid;
    mobile_[i] = pace_[i] = 0;
    slow_power_[i] = 0;
    // A diffusivity that stayed behind would hold the time step.
    thermal_diffusivity_[i] = diffusivity_[i] = 0;
    left.emplace(particles_.identity[i], i);
    moved.entries.push_back(i);
  }
  const auto entry = [&](std::int64_t identity) {
    for (auto* known : {&left, &vacated_}) {
      if (const auto found = known->find(identity); found != known->end()) {
        const std::uint32_t i = found->second;
        known->erase(found);
        return i;
      }
    }
    return free_slot();
  };
  const auto settle = [&](const Traveller& t, Home home) {
    const std::uint32_t i = entry(t.identity);
    unpack(i, t, home);
    flow_->set_particle(i, t.flow);
    moved.entries.push_back(i);
    moved.arrived.push_back(i);
    return i;
  };
  for (const Traveller& t : ranks.exchange(to)) {
    stays.push_back(settle(t, Home::here));
  }
  std::vector<int> near;
  std::vector<std::vector<Traveller>> copies(size);
  for (const std::uint32_t i : stays) {
    decomposition_.near(particles_.position[i], copy_reach(), near);
    for (const int r : near) {
      if (r != ranks.rank()) {
        copies[static_cast<std::size_t>(r)].push_back(pack(i));
        peers[static_cast<std::size_t>(r)].send.push_back(i);
      }
    }
  }
  for (const Traveller& t : ranks.exchange(copies)) {
    peers[static_cast<std::size_t>(t.rank)].receive.push_back(settle(t, Home::elsewhere));
  }
  for (const std::uint32_t i : moved.entries) {
    if (particles_.home[i] != Home::nowhere) {
      continue;
    }
    // An entry among those that were last put in order waits for its own particle: another one
    // there would have all lists behind it sorted by more than their indices.
    if (i < settled_) {
      vacated_.emplace(particles_.identity[i], i);
    } else {
      free_.push_back(i);
    }
  }
  set_peers(std::move(peers));
  return moved;
}

}  // namespace meltproof::solver

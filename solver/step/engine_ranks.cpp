// SPDX-License-Identifier: GPL-3.0-or-later
// How several ranks share an engine: who owns which particle, and who keeps copies of it.
#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "base/error.hpp"
#include "solver/step/engine.hpp"
#include "solver/step/traveller.hpp"

namespace meltproof::solver {
namespace {

template <class T>
void select(std::vector<T>& values, const std::vector<std::uint32_t>& kept) {
  std::vector<T> some;
  some.reserve(kept.size());
  for (const std::uint32_t i : kept) {
    some.push_back(values[i]);
  }
  values = std::move(some);
}

/// Sorts what mostly consists of a few sorted runs, one behind the other: they are merged, which
/// takes a comparison an entry instead of one for each of its bits.
template <class Less>
void sort_runs(std::vector<std::uint32_t>& indices, const Less& less) {
  constexpr std::ptrdiff_t short_run = 64;
  auto sorted = std::is_sorted_until(indices.begin(), indices.end(), less);
  while (sorted != indices.end()) {
    auto next = std::is_sorted_until(sorted, indices.end(), less);
    if (next - sorted < short_run) {
      std::sort(sorted, indices.end(), less);
      next = indices.end();
    }
    std::inplace_merge(indices.begin(), sorted, next, less);
    sorted = next;
  }
}

template <class T>
void select_if_there(std::vector<T>& values, const std::vector<std::uint32_t>& kept) {
  if (!values.empty()) {
    select(values, kept);
  }
}

}  // namespace

/// A little more than the lists reach, so that rounding never leaves a neighbour out.
double Engine::copy_reach() const { return (kernel_.support() + neighbours_.skin()) * (1 + 1e-9); }

void Engine::check_ranks() const {
  const auto refuse = [](const char* what) {
    throw InputError(std::string(what) +
                     " cannot be divided among several ranks: start the program without mpirun, "
                     "with --threads for the cores");
  };
  if (model_.gas) {
    refuse("flow.surroundings = \"gas\"");
  }
  if (model_.surface_conduction) {
    refuse("physics.surface_conduction = true");
  }
  for (const auto& faces : model_.domain.face) {
    for (const Face face : faces) {
      if (face != Face::open) {
        refuse("a domain with other than open faces");
      }
    }
  }
}

/// Keeps of all particles, which every rank holds, what is this rank's or near it. @param at where
/// they count as being. @returns which they were.
std::vector<std::uint32_t> Engine::divide(const std::vector<Vector>& at) {
  const Ranks& ranks = halo_->ranks();
  const auto size = static_cast<std::size_t>(ranks.size()),
             own = static_cast<std::size_t>(ranks.rank());
  const std::size_t n = particles_.size(), begin = n * own / size, end = n * (own + 1) / size;
  std::vector<Decomposition::Cost> costs;
  for (std::size_t i = begin; i < end; ++i) {
    costs.push_back(Decomposition::cost_at_first(particles_.phase[i]));
  }
  decomposition_.balance(std::span(at).subspan(begin, end - begin), costs);
  std::vector<std::uint32_t> kept;
  std::vector<int> near;
  for (std::uint32_t i = 0; i < n; ++i) {
    if (decomposition_.owner(at[i]) == ranks.rank()) {
      kept.push_back(i);
      continue;
    }
    decomposition_.near(at[i], copy_reach(), near);
    if (std::find(near.begin(), near.end(), ranks.rank()) != near.end()) {
      particles_.home[i] = Home::elsewhere;
      kept.push_back(i);
    }
  }
  std::vector<Vector> places = at;  // which may be the particles' own
  select(places, kept);
  particles_.each_array([&](auto& values) { select(values, kept); });
  // What an engine that goes on from a state knows beside.
  select_if_there(mobile_, kept);
  select_if_there(pace_, kept);
  select_if_there(slow_power_, kept);
  settled_ = particles_.size();
  add_free_slots();
  note_peers(places);
  return kept;
}

/// Free entries for particles that come from other ranks, so that indices and the void stay.
void Engine::add_free_slots() {
  const std::size_t n = particles_.size(), more = std::max<std::size_t>(64, n / 16);
  particles_.each_array([&](auto& values) { values.resize(n + more); });
  for (std::size_t i = n + more; i-- > n;) {
    particles_.home[i] = Home::nowhere;
    particles_.phase[i] = Phase::solid;
    free_.push_back(static_cast<std::uint32_t>(i));
  }
  fit_fields();
}

/// Every field of the engine as long as the particles' arrays.
void Engine::fit_fields() {
  const std::size_t n = particles_.size();
  for (auto* field : {&thermal_diffusivity_, &diffusivity_, &conducted_, &source_}) {
    field->resize(n, 0.0);
  }
  mobile_.resize(n, 0);
  slow_power_.resize(n, 0.0);
  pace_.resize(n, 0);
}

/// Who keeps copies of whom, by places alone. @param at per particle; free entries may be missing.
void Engine::note_peers(const std::vector<Vector>& at) {
  const int own = halo_->ranks().rank();
  std::vector<Halo::Peer> all(static_cast<std::size_t>(halo_->ranks().size()));
  std::vector<int> near;
  for (std::uint32_t i = 0; i < at.size(); ++i) {
    if (particles_.home[i] == Home::here) {
      decomposition_.near(at[i], copy_reach(), near);
      for (const int r : near) {
        if (r != own) {
          all[static_cast<std::size_t>(r)].send.push_back(i);
        }
      }
    } else if (particles_.home[i] == Home::elsewhere) {
      all[static_cast<std::size_t>(decomposition_.owner(at[i]))].receive.push_back(i);
    }
  }
  set_peers(std::move(all));
}

/// @param all an entry per rank.
void Engine::set_peers(std::vector<Halo::Peer> all) {
  std::vector<Halo::Peer> peers;
  for (std::size_t r = 0; r < all.size(); ++r) {
    Halo::Peer& peer = all[r];
    if (peer.send.empty() && peer.receive.empty()) {
      continue;
    }
    peer.rank = static_cast<int>(r);
    for (auto* indices : {&peer.send, &peer.receive}) {
      sort_runs(*indices,
                [&](std::uint32_t a, std::uint32_t b) { return particles_.before(a, b); });
    }
    peers.push_back(std::move(peer));
  }
  halo_->set_peers(std::move(peers));
}

Traveller Engine::pack(std::uint32_t i) const {
  Traveller t{};
  t.read(particles_, i);
  t.listed_at = listed_at(i);
  if (flow_) {
    t.flow = flow_->particle(i);
  }
  t.rank = halo_->ranks().rank();
  t.mobile = mobile_[i];
  t.pace = pace_[i];
  t.slow_power = slow_power_[i];
  return t;
}

void Engine::unpack(std::uint32_t i, const Traveller& t, Home home) {
  t.write(particles_, i);
  particles_.home[i] = home;
  mobile_[i] = t.mobile;
  pace_[i] = t.pace;
  slow_power_[i] = t.slow_power;
}

std::uint32_t Engine::free_slot() {
  if (free_.empty()) {
    add_free_slots();
    slots_added_ = true;
  }
  const std::uint32_t i = free_.back();
  free_.pop_back();
  return i;
}

/// Brings what a thermal step changes to the copies.
void Engine::update_copies() {
  halo_->exchange(
      Halo::everybody, 2,
      [&](std::uint32_t i, double* out) {
        out[0] = particles_.enthalpy[i];
        out[1] = particles_.concentration[i];
      },
      [&](std::uint32_t i, const double* in) {
        // Most of them stay as they are, and with them what follows, as in apply().
        if (particles_.enthalpy[i] == in[0] && particles_.concentration[i] == in[1] &&
            diffusivity_[i] == 0) {
          return;
        }
        particles_.enthalpy[i] = in[0];
        particles_.concentration[i] = in[1];
        refresh(i);
      });
}

std::vector<Traveller> Engine::gather(const std::vector<std::uint8_t>& chosen,
                                      bool everywhere) const {
  std::vector<Traveller> own;
  for (std::uint32_t i = 0; i < particles_.size(); ++i) {
    if (particles_.home[i] == Home::here && (chosen.empty() || chosen[i] != 0)) {
      own.push_back(pack(i));
    }
  }
  std::vector<Traveller> all = everywhere ? ranks().to_all(own) : ranks().to_root(own);
  std::sort(all.begin(), all.end(), comes_before);
  return all;
}

Particles Engine::collect(const std::vector<std::uint8_t>& chosen, double touch) const {
  const PackedLists& list = neighbours_.list();
  std::vector<std::uint8_t> wanted = chosen;
  for (std::uint32_t i = 0; i < particles_.size(); ++i) {
    if (chosen[i] == 0 || particles_.home[i] != Home::here) {
      continue;
    }
    const Vector& a = particles_.position[i];
    list.each(i, [&](std::uint32_t j) {
      if (j < particles_.size() && wanted[j] == 0) {
        const Vector& b = particles_.position[j];
        const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
        wanted[j] = x * x + y * y + z * z < touch * touch ? 1 : 0;
      }
    });
  }
  // Who finds that a copy is wanted tells the owner.
  halo_->give_back(
      Halo::everybody, 1, [&](std::uint32_t i, double* out) { *out = wanted[i]; },
      [&](std::uint32_t i, const double* in) { wanted[i] |= *in > 0 ? 1 : 0; });
  Particles found;
  found.dimensions = particles_.dimensions;
  found.spacing = particles_.spacing;
  if (ranks().alone()) {
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < particles_.size(); ++i) {
      if (wanted[i] != 0) {
        kept.push_back(i);
      }
    }
    particles_.each_array(found, [&](const auto& from, auto& to) {
      to.reserve(kept.size());
      for (const std::uint32_t i : kept) {
        to.push_back(from[i]);
      }
    });
    return found;
  }
  const std::vector<Traveller> all = gather(wanted, false);
  found.each_array([&](auto& values) { values.resize(all.size()); });
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].write(found, i);
    found.home[i] = Home::here;
  }
  return found;
}

}  // namespace meltproof::solver

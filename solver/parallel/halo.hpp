// SPDX-License-Identifier: GPL-3.0-or-later
// Copies of what other ranks own, kept up to date.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "solver/parallel/ranks.hpp"

namespace meltproof::solver {

/// **The halo**: per rank nearby, which of this rank's particles it keeps copies of, and which
/// copies of its particles are kept here. Both ends hold them in the same order. Alone there are no
/// peers and every exchange does nothing.
class Halo {
 public:
  struct Peer {
    int rank = 0;
    std::vector<std::uint32_t> send, receive;  ///< indices of particles on this rank
  };
  /// Of whom values are exchanged.
  enum Group : std::size_t { everybody = 0, liquid = 1, wall = 2, metal_near_melt = 3 };
  static constexpr std::size_t groups = 4;

  explicit Halo(const Ranks& ranks);

  const Ranks& ranks() const { return ranks_; }
  bool empty() const { return peers_.empty(); }
  void set_peers(std::vector<Peer> peers);
  /// Sorts out the groups. @param role per particle: 1 liquid, 2 wall, else neither; the same for a
  /// particle and its copies.
  void set_roles(std::span<const std::uint8_t> role);
  const std::vector<Peer>& peers() const { return peers_; }

  /// Brings values from owners to copies. @param get writes `width` numbers of particle i to out;
  /// @param put takes those of copy i.
  template <class Get, class Put>
  void exchange(Group group, std::size_t width, const Get& get, const Put& put) {
    begin(group, width, false, get);
    finish(put);
  }
  /// As exchange(), while what is computed between begin and finish needs none of it: the values
  /// are sent by begin(), which `get` must know then. One exchange at a time.
  template <class Get>
  void begin(Group group, std::size_t width, const Get& get) {
    begin(group, width, false, get);
  }
  /// Lets messages move on; worth a call now and then between begin() and finish().
  void progress();
  /// Waits for the values of the others.
  template <class Put>
  void finish(const Put& put) {
    if (peers_.empty()) {
      return;
    }
    wait();
    const auto& plans = plans_[group_];
    for (std::size_t p = 0; p < plans.size(); ++p) {
      const auto& to = back_ ? plans[p].send : plans[p].receive;
      for (std::size_t k = 0; k < to.size(); ++k) {
        put(to[k], &in_[p][width_ * k]);
      }
    }
  }
  /// The other way: from copies to their owners; an owner hears of every copy.
  template <class Get, class Put>
  void give_back(Group group, std::size_t width, const Get& get, const Put& put) {
    begin(group, width, true, get);
    finish(put);
  }
  /// Whether another rank keeps a copy of particle i, which must be melt or wall.
  bool copied(std::uint32_t i) const { return i < copied_.size() && copied_[i] != 0; }

  double waited() const { return waited_; }           ///< s, for other ranks so far
  std::size_t messages() const { return messages_; }  ///< sent so far
  double megabytes() const { return 1e-6 * 8 * static_cast<double>(numbers_); }  ///< sent so far

 private:
  template <class Get>
  void begin(Group group, std::size_t width, bool back, const Get& get) {
    if (peers_.empty()) {
      return;
    }
    group_ = group;
    width_ = width;
    back_ = back;
    const auto& plans = plans_[group];
    for (std::size_t p = 0; p < plans.size(); ++p) {
      const auto& from = back ? plans[p].receive : plans[p].send;
      out_[p].resize(width * from.size());
      in_[p].resize(width * (back ? plans[p].send : plans[p].receive).size());
      for (std::size_t k = 0; k < from.size(); ++k) {
        get(from[k], &out_[p][width * k]);
      }
    }
    post();
  }
  void post();
  void wait();

  Ranks ranks_;
  std::vector<Peer> peers_;
  std::array<std::vector<Peer>, groups> plans_;  // as peers_, of the group only
  std::vector<std::uint8_t> copied_;             // per particle, where it is melt or wall
  std::vector<std::vector<double>> out_, in_;    // per peer
  // Of the exchange that is under way.
  Group group_ = everybody;
  std::size_t width_ = 0;
  bool back_ = false;
  struct Requests;
  std::shared_ptr<Requests> requests_;  // hides MPI from those who include this
  std::size_t messages_ = 0, numbers_ = 0;
  double waited_ = 0;
};

}  // namespace meltproof::solver

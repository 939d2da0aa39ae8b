// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/parallel/halo.hpp"

#include <algorithm>
#include <utility>

#include <mpi.h>

namespace meltproof::solver {

void Halo::set_peers(std::vector<Peer> peers) {
  peers_ = std::move(peers);
  plans_[everybody] = peers_;
  out_.resize(peers_.size());
  in_.resize(peers_.size());
}

void Halo::set_roles(std::span<const std::uint8_t> role) {
  const auto keep = [&](const std::vector<std::uint32_t>& all, Group group) {
    std::vector<std::uint32_t> some;
    std::copy_if(all.begin(), all.end(), std::back_inserter(some), [&](std::uint32_t i) {
      return group == metal_near_melt ? role[i] == 1 || role[i] == 2 : role[i] == group;
    });
    return some;
  };
  copied_.assign(role.size(), 0);
  for (const Peer& peer : peers_) {
    for (const std::uint32_t i : peer.send) {
      copied_[i] = role[i] != 0 ? 1 : 0;
    }
  }
  for (const Group group : {liquid, wall, metal_near_melt}) {
    plans_[group].clear();
    for (const Peer& peer : peers_) {
      plans_[group].push_back({peer.rank, keep(peer.send, group), keep(peer.receive, group)});
    }
  }
}

struct Halo::Requests {
  std::vector<MPI_Request> all;
};

Halo::Halo(const Ranks& ranks) : ranks_(ranks), requests_(std::make_shared<Requests>()) {}

void Halo::post() {
  constexpr int tag = 2;
  std::vector<MPI_Request>& requests = requests_->all;
  requests.clear();
  for (std::size_t p = 0; p < peers_.size(); ++p) {
    if (!in_[p].empty()) {
      MPI_Irecv(in_[p].data(), static_cast<int>(in_[p].size()), MPI_DOUBLE, peers_[p].rank, tag,
                MPI_COMM_WORLD, &requests.emplace_back());
    }
    if (!out_[p].empty()) {
      MPI_Isend(out_[p].data(), static_cast<int>(out_[p].size()), MPI_DOUBLE, peers_[p].rank, tag,
                MPI_COMM_WORLD, &requests.emplace_back());
      ++messages_;
      numbers_ += out_[p].size();
    }
  }
}

void Halo::progress() {
  int done = 0;
  MPI_Testall(static_cast<int>(requests_->all.size()), requests_->all.data(), &done,
              MPI_STATUSES_IGNORE);
}

void Halo::wait() {
  const double began = MPI_Wtime();
  MPI_Waitall(static_cast<int>(requests_->all.size()), requests_->all.data(), MPI_STATUSES_IGNORE);
  waited_ += MPI_Wtime() - began;
}

}  // namespace meltproof::solver

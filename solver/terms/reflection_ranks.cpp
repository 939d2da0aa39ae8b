// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/terms/reflection_ranks.hpp"

#include <algorithm>
#include <array>

namespace meltproof::solver {

Box box_of_metal(const Particles& particles, const Ranks& ranks) {
  Box box;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (particles.phase[i] != Phase::lost && particles.home[i] == Home::here) {
      box.add(particles.position[i]);
    }
  }
  ranks.smallest(box.lower);
  ranks.largest(box.upper);
  return box;
}

SharedMetal::SharedMetal(const Particles& particles,
                         const std::function<double(std::uint32_t)>& absorptivity, const Box& box,
                         const Ranks& ranks)
    : own_(particles),
      absorptivity_(absorptivity),
      ranks_(ranks),
      box_(box),
      blocks_(box, 2 * ray_stride * particles.spacing) {
  known_.spacing = particles.spacing;
  known_.dimensions = particles.dimensions;
  fetch({0});
}

bool SharedMetal::fetch(std::vector<std::uint64_t> wanted) {
  const auto only_once = [](std::vector<std::uint64_t>& blocks) {
    std::sort(blocks.begin(), blocks.end());
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  };
  only_once(wanted);
  wanted = ranks_.to_all(wanted);
  only_once(wanted);
  if (wanted.empty()) {
    return false;
  }
  constexpr std::uint8_t known = 1, asked = 2;
  for (const std::uint64_t block : wanted) {
    blocks_.known[block] = asked;
  }
  std::vector<Piece> pieces;
  for (std::uint32_t i = 0; i < own_.size(); ++i) {
    if (own_.home[i] == Home::here && own_.phase[i] != Phase::lost &&
        blocks_.known[blocks_.of(own_.position[i])] == asked) {
      pieces.push_back({own_.position[i], absorptivity_(i), own_.identity[i], own_.order[i],
                        static_cast<std::uint32_t>(ranks_.rank()), i});
    }
  }
  for (const std::uint64_t block : wanted) {
    blocks_.known[block] = known;
  }
  const std::vector<Piece> found = ranks_.to_all(pieces);
  metal_.insert(metal_.end(), found.begin(), found.end());
  std::sort(metal_.begin(), metal_.end(), [](const Piece& a, const Piece& b) {
    return a.order != b.order ? a.order < b.order : a.identity < b.identity;
  });
  known_.position.clear();
  for (const Piece& piece : metal_) {
    known_.position.push_back(piece.position);
  }
  // The cells must be those of all metal.
  known_.position.push_back(box_.lower);
  known_.position.push_back(box_.upper);
  const std::size_t n = known_.position.size();
  known_.identity.assign(n, 0);
  known_.phase.assign(n, Phase::solid);
  known_.home.assign(n, Home::here);
  return true;
}

void SharedMetal::keep(std::size_t ray, const Deposits& deposits) {
  for (const auto& [particle, absorbed] : deposits) {
    const Piece& piece = metal_[particle];
    deposits_.push_back({ray, absorbed, piece.rank, piece.index});
  }
}

void SharedMetal::each_deposit(const std::function<void(std::uint32_t, double, bool)>& add) const {
  std::vector<Deposit> all = ranks_.to_all(deposits_);
  // Each ray was followed on one rank, where its deposits stand in their order.
  std::stable_sort(all.begin(), all.end(),
                   [](const Deposit& a, const Deposit& b) { return a.ray < b.ray; });
  const auto own = static_cast<std::uint32_t>(ranks_.rank());
  for (const Deposit& deposit : all) {
    add(deposit.index, deposit.absorbed, deposit.rank == own);
  }
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// What every pass over the particles is written with.
#pragma once

#include "solver/multiphase/closed_flow.hpp"
#include "solver/particles/loops.hpp"

namespace meltproof::solver {

/// Calls body(pair, indices of its j) for every group of lanes in the list of i.
template <int D, class Record, class Body>
void for_each_group(const NeighbourList& list, std::size_t i, const Record* all, const Body& body) {
  const auto own = spread<D>(all[i], Record::position());
  for (std::size_t k = list.first[i]; k < list.last[i]; k += lane_count) {
    const std::uint32_t* j = &list.index[k];
    body(PairGeometry<D, Lane>(own, gather<D>(all, j, Record::position())), j);
  }
}

/// Copies the records of all ghosts from their sources, at their own places; change(image, ghost)
/// then makes of the copy what a mirror shows.
template <class Record, class Change>
void ClosedFlow::fill_images(std::vector<Record>& records, const Change& change) const {
  const std::size_t n = particles_.size();
  for_each_particle(ghosts_.size(), [&](std::size_t g) {
    const Ghost& ghost = ghosts_[g];
    Record& image = records[n + g];
    image = records[ghost.source];
    set(image, Record::position(), ghost.image_of(particles_.position[ghost.source]));
    change(image, ghost);
  });
}

}  // namespace meltproof::solver

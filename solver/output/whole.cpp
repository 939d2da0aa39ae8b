// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/whole.hpp"

#include <algorithm>
#include <numeric>

namespace meltproof::solver {

Whole::Whole(const Engine& engine) {
  const Particles& p = engine.particles();
  if (engine.ranks().alone()) {
    particles_ = &p;
    return;
  }
  std::vector<std::uint32_t> own, order;
  for (std::uint32_t i = 0; i < p.size(); ++i) {
    if (p.home[i] == Home::here) {
      own.push_back(i);
    }
  }
  Particles& all = gathered_;
  all.spacing = p.spacing;
  all.dimensions = p.dimensions;
  // By way of T, whose size the exchange of ranks asks to be whole words.
  const auto bring = [&]<class T, class Values>(T, const Values& from, Values& to) {
    std::vector<T> part;
    part.reserve(own.size());
    for (const std::uint32_t i : own) {
      part.push_back(static_cast<T>(from[i]));
    }
    const std::vector<T> found = engine.ranks().to_root(part);
    to.reserve(found.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      to.push_back(static_cast<typename Values::value_type>(found[order.empty() ? k : order[k]]));
    }
  };
  bring(std::uint64_t{}, p.order, all.order);
  bring(std::int64_t{}, p.identity, all.identity);
  std::vector<std::uint32_t> sorted(all.size());
  std::iota(sorted.begin(), sorted.end(), 0U);
  std::sort(sorted.begin(), sorted.end(),
            [&](std::uint32_t a, std::uint32_t b) { return all.before(a, b); });
  order = std::move(sorted);
  all.order.clear();
  all.identity.clear();
  bring(std::uint64_t{}, p.order, all.order);
  bring(std::int64_t{}, p.identity, all.identity);
  bring(Vector{}, p.position, all.position);
  bring(double{}, p.mass, all.mass);
  bring(double{}, p.volume, all.volume);
  bring(double{}, p.peak_temperature, all.peak_temperature);
  bring(std::uint64_t{}, p.phase, all.phase);
  bring(std::uint64_t{}, p.melted, all.melted);
  all.home.assign(all.size(), Home::here);
}

}  // namespace meltproof::solver

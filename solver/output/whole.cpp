// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/whole.hpp"

namespace meltproof::solver {

Whole::Whole(const Engine& engine) {
  const bool flow = engine.model().flow.has_value();
  if (engine.ranks().alone()) {
    particles_ = &engine.particles();
    for (std::uint32_t i = 0; flow && i < particles_->size(); ++i) {
      pressure_.push_back(engine.flow().pressure(i));
    }
    return;
  }
  gathered_.spacing = engine.particles().spacing;
  gathered_.dimensions = engine.particles().dimensions;
  const std::vector<Traveller> all = engine.gather();
  gathered_.each_array([&](auto& values) { values.resize(all.size()); });
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].write(gathered_, i);
    gathered_.home[i] = Home::here;
    if (flow) {
      pressure_.push_back(all[i].flow.pressure);
    }
  }
}

}  // namespace meltproof::solver

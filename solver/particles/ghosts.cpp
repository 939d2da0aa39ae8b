// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/particles/ghosts.hpp"

#include <algorithm>
#include <cmath>

namespace meltproof::solver {

std::vector<Ghost> make_ghosts(const Particles& particles, const Domain& domain, double reach) {
  const bool open = std::all_of(domain.face.begin(), domain.face.end(), [](const auto& axis) {
    return axis[0] == Face::open && axis[1] == Face::open;
  });
  if (open) {
    return {};
  }
  // The particles themselves stand first and are cut off at the end.
  std::vector<Ghost> all;
  all.reserve(particles.size() * 2);
  for (std::uint32_t i = 0; i < particles.size(); ++i) {
    all.push_back({.source = i, .position = particles.position[i], .sign = 1, .offset = 0});
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double lower = domain.lower[axis], upper = domain.upper[axis], length = upper - lower;
    const std::size_t count = all.size();
    const auto inside = [&](double x) { return x > lower - reach && x < upper + reach; };
    if (domain.face[axis][0] == Face::periodic) {
      const int images = static_cast<int>(std::ceil(reach / length));
      for (int k = -images; k <= images; ++k) {
        for (std::size_t i = 0; i < count && k != 0; ++i) {
          Ghost image = all[i];
          image.position[axis] += k * length;
          image.shift[axis] += k * length;
          if (inside(image.position[axis])) {
            all.push_back(image);
          }
        }
      }
      continue;
    }
    for (std::size_t side = 0; side < 2; ++side) {
      const Face face = domain.face[axis][side];
      if (face == Face::open) {
        continue;
      }
      const double plane = side == 0 ? lower : upper;
      for (std::size_t i = 0; i < count; ++i) {
        Ghost image = all[i];
        image.position[axis] = 2 * plane - image.position[axis];
        image.scale[axis] = -image.scale[axis];
        image.shift[axis] = 2 * plane - image.shift[axis];
        if (!inside(image.position[axis])) {
          continue;
        }
        if (face == Face::temperature) {
          image.sign = -image.sign;
          image.offset = 2 * domain.temperature[axis][side] - image.offset;
        }
        all.push_back(image);
      }
    }
  }
  all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(particles.size()));
  return all;
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// What every pass over pairs begins with: how far apart, and the sums of a corrected gradient.
#pragma once

#include <cstdint>

#include "solver/particles/kernel.hpp"
#include "solver/particles/lanes.hpp"
#include "solver/terms/interface.hpp"

namespace meltproof::solver {

/// r_ij = r_i - r_j of one particle and as many others as there are lanes, m.
struct Separation {
  Lane dx, dy, dz;
  Lane r2, r;  ///< r is never zero, so that it may divide
};

/// Of `own` and the records that `j` names; any record with x, y and z will do.
template <class Record>
[[gnu::always_inline]] inline Separation separation(const Record& own, const Record* all,
                                                    const std::uint32_t* j) {
  const Lane dx = own.x - gather(all, j, &Record::x);
  const Lane dy = own.y - gather(all, j, &Record::y);
  const Lane dz = own.z - gather(all, j, &Record::z);
  const Lane r2 = dx * dx + dy * dy + dz * dz;
  return {dx, dy, dz, r2, square_root(larger(r2, Lane(1e-40)))};
}

/// F = r_ij . grad_i W / (r^2 + (0.1 h)^2), never positive, m^-(d+2). (Cleary & Monaghan 1999)
[[gnu::always_inline]] inline Lane softened_slope(const QuinticSpline& kernel, const Lane& r,
                                                  const Lane& r2) {
  return r * kernel.slope(r) / (r2 + kernel.regularisation);
}

/// The sums from which surface_gradient() takes the gradient of a quantity, lane by lane.
struct GradientSums {
  Lane x = 0, y = 0, z = 0;
  Lane xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  /// One summand: `factor` is F or zero, `step` the quantity's difference s_i - s_j.
  [[gnu::always_inline]] void add(const Lane& factor, const Lane& step, const Lane& dx,
                                  const Lane& dy, const Lane& dz) {
    const Lane change = factor * step;
    x += change * dx;
    y += change * dy;
    z += change * dz;
    xx += factor * dx * dx;
    yy += factor * dy * dy;
    zz += factor * dz * dz;
    xy += factor * dx * dy;
    xz += factor * dx * dz;
    yz += factor * dy * dz;
  }

  InterfaceSums total() const {
    InterfaceSums sums;
    sums.difference = {sum_lanes(x), sum_lanes(y), sum_lanes(z)};
    sums.moment = {sum_lanes(xx), sum_lanes(yy), sum_lanes(zz),
                   sum_lanes(xy), sum_lanes(xz), sum_lanes(yz)};
    return sums;
  }
};

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/multiphase/depth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace meltproof::solver {

InterfaceDepth::InterfaceDepth(const QuinticSpline& kernel, int dimensions) {
  constexpr int entries = 60, parts = 400;
  const double support = kernel.support(), pi = std::numbers::pi;
  step_ = support / entries;
  for (int k = 0; k <= entries; ++k) {
    const double s = k * step_, width = (support - s) / parts;
    double sum = 0;
    for (int part = 0; part < parts; ++part) {
      const double r = s + (part + 0.5) * width;
      const double beyond = dimensions == 2 ? 2 * r * std::acos(s / r) : 2 * pi * r * (r - s);
      sum += kernel.value(r) * beyond * width;
    }
    share_.push_back(sum);
  }
}

double InterfaceDepth::operator()(double share) const {
  const auto above = std::partition_point(share_.begin(), share_.end(),
                                          [&](double entry) { return entry > share; });
  if (above == share_.begin()) {
    return 0;
  }
  const auto k = static_cast<double>(above - share_.begin());
  if (above == share_.end()) {
    return step_ * (k - 1);
  }
  const double before = *(above - 1), after = *above;
  return step_ * (k - 1 + (before - share) / (before - after));
}

double curvature_at_interface(double curvature, double depth, int dimensions) {
  // Where the surface curls within the depth itself there is no parallel surface to go to.
  constexpr double tightest = 0.3;
  return curvature / std::max(tightest, 1 + curvature * depth / (dimensions - 1));
}

}  // namespace meltproof::solver

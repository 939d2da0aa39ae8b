// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/interaction_volume.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace meltproof::validation {
namespace {

TEST(InteractionVolume, RangesAtThePapersThirtyKilovolt) {
  EXPECT_NEAR(1e6 * kanaya_okayama_range(iron, 30), 3.16, 0.005);
  EXPECT_NEAR(1e6 * kanaya_okayama_range(aluminium, 30), 8.24, 0.005);
  EXPECT_NEAR(1e6 * anderson_hasler_range(iron.density, 30, aluminium_k_edge), 2.45, 0.005);
  EXPECT_THROW(anderson_hasler_range(iron.density, 1.5, aluminium_k_edge), InputError);
}

/// Where a rising profile of even steps reaches `level`.
double crossing(const std::vector<double>& values, double first, double step, double level) {
  std::size_t i = 1;
  while (values[i] < level) {
    ++i;
  }
  const double part = (level - values[i - 1]) / (values[i] - values[i - 1]);
  return first + step * (static_cast<double>(i - 1) + part);
}

TEST(InteractionVolume, AStepOfOneMicrometreSeenWithOneAndAHalf) {
  const double first = -20, step = 0.01;
  std::vector<double> profile;
  for (int i = 0; i <= 4000; ++i) {
    profile.push_back(0.5 * (1 + std::erf((first + i * step) / std::sqrt(2.0))));
  }
  const auto seen = convolve_gaussian(profile, step, 1.5);
  const auto width = [&](const std::vector<double>& p) {
    return crossing(p, first, step, 0.9) - crossing(p, first, step, 0.1);
  };
  EXPECT_NEAR(width(profile), 2.56, 0.005);
  EXPECT_NEAR(width(seen), 4.62, 0.005);
  EXPECT_NEAR(width(seen) / width(profile), 1.803, 0.0005);  // sigma: sqrt(1 + 1.5^2)
}

TEST(InteractionVolume, KeepsAUniformProfileAndGaps) {
  const double gap = std::numeric_limits<double>::quiet_NaN();
  const auto seen = convolve_gaussian(std::vector<double>{0.3, 0.3, gap, 0.3}, 1, 2);
  EXPECT_NEAR(seen[0], 0.3, 1e-15);
  EXPECT_NEAR(seen[3], 0.3, 1e-15);
  EXPECT_TRUE(std::isnan(seen[2]));
}

TEST(InteractionVolume, NoWidthChangesNothing) {
  const std::vector<double> profile = {0, 1, 0};
  EXPECT_EQ(convolve_gaussian(profile, 1, 0), profile);
  EXPECT_NEAR(convolve_gaussian(profile, 1, 1e-3)[1], 1, 1e-12);
  EXPECT_THROW(convolve_gaussian(profile, 0, 1), InputError);
  EXPECT_THROW(convolve_gaussian(profile, 1, -1), InputError);
}

}  // namespace
}  // namespace meltproof::validation

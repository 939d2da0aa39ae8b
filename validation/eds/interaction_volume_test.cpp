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

TEST(LocalMatrix, ItsEndsAreThePublishedRanges) {
  EXPECT_NEAR(1e6 * kanaya_okayama_range_in_mixture(0, 30), 3.16, 0.005);
  EXPECT_NEAR(1e6 * kanaya_okayama_range_in_mixture(1, 30), 8.24, 0.005);
  EXPECT_DOUBLE_EQ(mixture_density(0), iron.density);
  EXPECT_DOUBLE_EQ(mixture_density(1.02), aluminium.density);
  // Half of each by mass: 2 / (1/7874 + 1/2700).
  EXPECT_NEAR(mixture_density(0.5), 4021, 1);
  EXPECT_NEAR(anderson_hasler_range(mixture_density(1), 30, aluminium_k_edge) /
                  anderson_hasler_range(mixture_density(0), 30, aluminium_k_edge),
              7874.0 / 2700, 1e-12);
}

// In one matrix it is the plain convolution.
TEST(LocalMatrix, OfOneDensityIsAGaussian) {
  std::vector<double> profile;
  for (int i = 0; i < 200; ++i) {
    profile.push_back(i < 90 ? 0 : 1);
  }
  const auto plain = convolve_gaussian(profile, 0.1, 1);
  const auto local = convolve_in_matrix(profile, std::vector<double>(200, 4000), 0.1, 4000);
  for (std::size_t i = 0; i < 200; ++i) {
    EXPECT_NEAR(local[i], plain[i], 2e-6);
  }
}

TEST(LocalMatrix, BlursAluminiumWidelyAndIronNarrowlyAndKeepsTheMass) {
  const double step = 0.02e-6, range = anderson_hasler_range(iron.density, 30, aluminium_k_edge);
  std::vector<double> profile, density;
  for (int i = 0; i < 2600; ++i) {  // 52 um: iron, and a strip of aluminium from 16 to 36 um
    profile.push_back(i < 800 || i >= 1800 ? 0 : 1);
    density.push_back(mixture_density(profile.back()));
  }
  const auto seen =
      convolve_in_matrix(profile, density, step, interaction_sigma(range) * iron.density);
  // Where it is seen at 10 % (in iron) and 90 % (in aluminium) beside the edge at 16 um.
  const auto place = [&](double level) {
    std::size_t i = 0;
    while (seen[i] < level) {
      ++i;
    }
    return 1e6 * step * static_cast<double>(i);
  };
  const double quantile = 1.2816;  // of a Gaussian at 10 %
  const double in_iron = 1e6 * interaction_sigma(range);
  EXPECT_NEAR(16 - place(0.1), quantile * in_iron, 0.03);
  EXPECT_NEAR(place(0.9) - 16, quantile * in_iron * iron.density / aluminium.density, 0.08);
  double before = 0, after = 0;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    before += density[i] * profile[i];
    after += density[i] * seen[i];
  }
  EXPECT_NEAR(after / before, 1, 1e-4);
}

TEST(LocalMatrix, KeepsAUniformProfileAndGaps) {
  const double gap = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> density = {7000, 3000, 7000, 2700};
  const auto seen = convolve_in_matrix(std::vector<double>{0.3, 0.3, gap, 0.3}, density, 1, 9000);
  EXPECT_NEAR(seen[0], 0.3, 1e-15);
  EXPECT_NEAR(seen[3], 0.3, 1e-15);
  EXPECT_TRUE(std::isnan(seen[2]));
  EXPECT_THROW(convolve_in_matrix(seen, std::vector<double>{1}, 1, 1), InputError);
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/metrics/sensitivity.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace meltproof::validation {
namespace {

TEST(Sensitivities, APowerLawHasItsExponent) {
  const auto f = [](double x) { return 7 * std::pow(x, 1.5); };
  const VariedInput runs[] = {{0.99, f(0.99)}, {1.01, f(1.01)}};
  const auto found = sensitivity(1, 0.1, f(1), runs);
  EXPECT_NEAR(found.relative, 1.5, 1e-4);
  EXPECT_NEAR(found.uncertainty, 0.15, 1e-5);
  EXPECT_FALSE(found.one_sided || found.same_side);
}

TEST(Sensitivities, ACentralDifferenceOfAParabolaIsExactAndAOneSidedOneIsNot) {
  const auto f = [](double x) { return 3 + x + 5 * (x - 2) * (x - 2); };
  const VariedInput both[] = {{1.9, f(1.9)}, {2.1, f(2.1)}};
  EXPECT_NEAR(sensitivity(2, 0, f(2), both).relative, 2.0 / 5, 1e-12);
  const VariedInput one[] = {{2.1, f(2.1)}};
  const auto found = sensitivity(2, 0, f(2), one);
  EXPECT_TRUE(found.one_sided);
  EXPECT_NEAR(found.relative, 2 * (1 + 5 * 0.1) / 5, 1e-12);
}

TEST(Sensitivities, OfAFactorItsLogarithmCounts) {
  // f grows by 3 % with each doubling, however the steps lie.
  const auto f = [](double x) { return 1 + 0.03 * std::log2(x / 20); };
  const VariedInput runs[] = {{10, f(10)}, {80, f(80)}};
  EXPECT_NEAR(sensitivity(20, 0.4, 1, runs, true).relative, 0.03 / std::log(2.0), 1e-12);
}

TEST(Sensitivities, AnExtremeAtTheBaseIsNamedAndNotAveragedAway) {
  const VariedInput runs[] = {{0.9, 1.02}, {1.1, 1.03}};
  const auto found = sensitivity(1, 0.1, 1, runs);
  EXPECT_TRUE(found.same_side);
  EXPECT_NEAR(found.relative, 0.3, 1e-12);  // a central difference would say 0.05
}

TEST(Sensitivities, RunsThatTellNothingAreRefused) {
  const VariedInput above[] = {{1.1, 2}, {1.2, 3}};
  EXPECT_THROW(sensitivity(1, 0, 1, above), InputError);
  const VariedInput same[] = {{1, 2}};
  EXPECT_THROW(sensitivity(1, 0, 1, same), InputError);
  const VariedInput negative[] = {{-1, 2}};
  EXPECT_THROW(sensitivity(1, 0, 1, negative, true), InputError);
  EXPECT_THROW(sensitivity(1, 0, 1, {}), InputError);
  EXPECT_THROW(sensitivity(1, 0, 0, above), InputError);
}

TEST(Sensitivities, AChoiceIsARectangleAsWideAsTheOtherLawIsAway) {
  const double other[] = {1.02, 0.97};
  EXPECT_NEAR(choice_uncertainty(1, other), 0.03 / std::sqrt(3.0), 1e-12);
  EXPECT_THROW(choice_uncertainty(1, {}), InputError);
}

}  // namespace
}  // namespace meltproof::validation

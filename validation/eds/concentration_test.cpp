// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/concentration.hpp"

#include <cmath>
#include <random>

#include "validation/eds/eds_test_files.hpp"

namespace meltproof::validation {
namespace {

/// A synthetic mixture of the two alloys, `amount` of it in all, with uncertainty u of each
/// element.
LineScan mixture(const std::vector<double>& concentration, double amount, double u) {
  LineScan scan;
  for (std::size_t i = 0; i < concentration.size(); ++i) {
    scan.position.push_back(1e-6 * static_cast<double>(i));
    ElementFractions mass;
    for (const auto& [symbol, value] : alsi10mg_composition()) {
      mass[symbol] += amount * concentration[i] * value;
    }
    for (const auto& [symbol, value] : steel_316l_composition()) {
      mass[symbol] += amount * (1 - concentration[i]) * value;
    }
    for (const auto& [symbol, value] : mass) {
      scan.elements[symbol].fraction.push_back(value);
      if (u > 0) {
        scan.elements[symbol].uncertainty.push_back(u);
      }
    }
  }
  check_totals(scan);
  return scan;
}

TEST(Concentration, TheAlloysThemselvesAddToOne) {
  double sum = 0;
  for (const auto& [symbol, value] : steel_316l_composition()) {
    sum += value;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
}

TEST(Concentration, ThreeWaysAgreeOnAMixture) {
  const LineScan scan = mixture({0, 0.3, 0.7, 1}, 1, 0.002);
  const auto al = concentration_from_aluminium(scan);
  const auto si = concentration_from_silicon(scan, steel_316l_composition().at("Si"));
  const auto all = concentration_by_least_squares(scan, steel_316l_composition());
  EXPECT_TRUE(all.weighted);
  for (std::size_t i = 0; i < 4; ++i) {
    const double c = std::vector<double>{0, 0.3, 0.7, 1}[i];
    EXPECT_NEAR(al.concentration[i], c, 1e-12);
    EXPECT_NEAR(si.concentration[i], c, 1e-12);
    EXPECT_NEAR(all.profile.concentration[i], c, 1e-12);
    EXPECT_NEAR(all.amount[i], 1, 1e-12);
    EXPECT_NEAR(all.reduced_chi_square[i], 0, 1e-12);
  }
  // All elements together know more than aluminium alone, and aluminium more than silicon.
  EXPECT_LT(all.profile.uncertainty[1], al.uncertainty[1]);
  EXPECT_LT(al.uncertainty[1], si.uncertainty[1]);
}

TEST(Concentration, ATotalOffAHundredShowsAsAmountAndDoesNotBendLeastSquares) {
  const LineScan scan = mixture({0.4}, 0.9, 0.002);
  const auto all = concentration_by_least_squares(scan, steel_316l_composition());
  EXPECT_NEAR(all.profile.concentration[0], 0.4, 1e-12);
  EXPECT_NEAR(all.amount[0], 0.9, 1e-12);
  EXPECT_NEAR(concentration_from_aluminium(scan).concentration[0], 0.36, 1e-12);
  EXPECT_EQ(scan.flagged, std::vector<std::size_t>{0});
}

// The covariance is that of many measurements with such noise.
TEST(Concentration, TheCovarianceIsThatOfRepeatedMeasurements) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0, 0.005);
  LineScan scan = mixture(std::vector<double>(4000, 0.4), 1, 0.005);
  for (auto& [symbol, profile] : scan.elements) {
    for (double& value : profile.fraction) {
      value += noise(random);
    }
  }
  const auto all = concentration_by_least_squares(scan, steel_316l_composition());
  double mean = 0, squares = 0, chi = 0;
  for (std::size_t i = 0; i < 4000; ++i) {
    mean += all.profile.concentration[i] / 4000;
    squares += std::pow(all.profile.concentration[i] - 0.4, 2) / 4000;
    chi += all.reduced_chi_square[i] / 4000;
  }
  EXPECT_NEAR(mean, 0.4, 4 * all.profile.uncertainty[0] / std::sqrt(4000.0));
  EXPECT_NEAR(std::sqrt(squares), all.profile.uncertainty[0], 0.05 * all.profile.uncertainty[0]);
  EXPECT_NEAR(chi, 1, 0.05);
}

TEST(Concentration, WhatIsNoMixtureOfTheTwoAlloysHasALargeChiSquare) {
  LineScan scan = mixture({0.4}, 1, 0.002);
  scan.elements["Cu"] = {{0.1}, {0.002}, {}, {}};
  EXPECT_GT(concentration_by_least_squares(scan, steel_316l_composition()).reduced_chi_square[0],
            100);
}

TEST(Concentration, WithoutUncertaintiesTheResidualsTellIt) {
  LineScan scan = mixture({0.4}, 1, 0);
  scan.elements.at("Fe").fraction[0] += 0.01;
  const auto all = concentration_by_least_squares(scan, steel_316l_composition());
  EXPECT_FALSE(all.weighted);
  EXPECT_GT(all.profile.uncertainty.at(0), 1e-4);
  EXPECT_TRUE(all.reduced_chi_square.empty());
  std::erase_if(scan.elements, [](const auto& e) { return e.first != "Fe" && e.first != "Al"; });
  EXPECT_TRUE(
      concentration_by_least_squares(scan, steel_316l_composition()).profile.uncertainty.empty());
  scan.elements.erase("Fe");
  EXPECT_REFUSED(concentration_by_least_squares(scan, steel_316l_composition()),
                 "at least two elements");
}

TEST(Concentration, NoiseOfCounts) {
  EXPECT_DOUBLE_EQ(counting_noise(100, 0), 10);
  EXPECT_DOUBLE_EQ(counting_noise(100, 150), 20);
}

}  // namespace
}  // namespace meltproof::validation

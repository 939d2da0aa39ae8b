// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/metrics/log_ratio.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace meltproof::validation {
namespace {

TEST(LogRatio, RecoversBiasAndScatterOfASyntheticModel) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> model(1.2, 0.15 * 1.2), measured(1.0, 0.1);
  std::vector<RatioDatum> data;
  for (int i = 0; i < 40000; ++i) {
    const double truth = 100 + i % 300;
    data.push_back({truth * model(random), truth * measured(random), 0.1});
  }
  const auto result = log_ratio(data);
  EXPECT_NEAR(result.bias, 1.2, 0.006);
  EXPECT_NEAR(result.model_scatter, 0.15, 0.006);
  EXPECT_NEAR(result.measured_scatter, 0.1, 1e-10);
}

TEST(LogRatio, OfExactDataIsTheirRatio) {
  const std::vector<RatioDatum> data = {{110, 100, 0}, {220, 200, 0}, {33, 30, 0}};
  EXPECT_NEAR(log_ratio(data).bias, 1.1, 1e-12);
  EXPECT_NEAR(log_ratio(data).model_scatter, 0, 1e-7);
}

TEST(LogRatio, DoesNotBlameTheModelForTheMeasurement) {
  const std::vector<RatioDatum> data = {{100, 95, 0.2}, {100, 105, 0.2}};
  EXPECT_TRUE(log_ratio(data).scatter_is_noise);
  EXPECT_EQ(log_ratio(data).model_scatter, 0);
  EXPECT_THROW(log_ratio(std::vector<RatioDatum>{{1, 1, 0}}), InputError);
  EXPECT_THROW(log_ratio(std::vector<RatioDatum>{{1, 1, 0}, {-1, 1, 0}}), InputError);
}

}  // namespace
}  // namespace meltproof::validation

// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/linescan/line_comparison.hpp"

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "validation/linescan/synthetic_track.hpp"

namespace meltproof::validation {
namespace {

namespace fs = std::filesystem;

double smooth(const Point& p) { return 0.5 * std::erfc((p[1] + 4e-6) / 6e-6); }
bool one_grain(const Point& p) {
  return std::hypot(p[0] - 20e-6, p[1] - 20e-6, p[2] + 6e-6) < 4e-6;
}

fs::path synthetic_run(const std::function<bool(const Point&)>& additive) {
  const fs::path path = fs::path(testing::TempDir()) / "synthetic_run.h5";
  write_synthetic_run(synthetic_track(smooth, additive), path);
  return path;
}

TEST(LineComparison, IsPendingWithoutAMeasurement) {
  LineRequest request;
  request.run = synthetic_run(one_grain);
  request.grain = Direction::lateral;
  const auto result = compare_line(request);
  EXPECT_EQ(result["status"], "pending");
  EXPECT_TRUE(result["measured"].is_null());
  EXPECT_TRUE(result["metrics"].is_null());
  EXPECT_EQ(result["line"]["direction"], "lateral");
  EXPECT_TRUE(result["line"]["resolved"]);
  request.length = 10e-6;
  EXPECT_FALSE(compare_line(request)["line"]["resolved"]);
  EXPECT_EQ(result["simulated"]["position_um"].size(), 81u);
  EXPECT_EQ(result["simulated"]["concentration"].size(), 81u);
  EXPECT_EQ(result["simulated"]["concentration_seen"].size(), 81u);
  EXPECT_NEAR(result["interaction"]["range_um"].get<double>(), 2.45, 0.005);
  EXPECT_NEAR(result["grain"]["edge_distance_um"].get<double>(), 9, 1e-6);
}

TEST(LineComparison, RecoversItsOwnProfileFromACsvWithAnotherOrigin) {
  LineRequest request;
  request.run = synthetic_run(one_grain);
  request.start = {20e-6, -25e-6, -20e-6};
  request.end = {20e-6, 25e-6, -20e-6};
  const auto simulated = compare_line(request)["simulated"];
  const fs::path csv = fs::path(testing::TempDir()) / "synthetic_scan.csv";
  {
    std::ofstream out(csv);
    out << "synthetic: the simulated profile itself, 1.5 um further along\nDistance (um),Al Wt%,Al "
           "Wt% Sigma,Fe Wt%\n";
    for (std::size_t i = 20; i < 180; i += 8) {
      const double al = 89.65 * simulated["concentration_seen"][i].get<double>();
      out << simulated["position_um"][i].get<double>() - 1.5 << "," << al << ",0.5," << 100 - al
          << "\n";
    }
  }
  request.measured = csv;
  request.bounds.shift = 3e-6;
  const auto result = compare_line(request);
  EXPECT_EQ(result["status"], "compared");
  EXPECT_NEAR(result["registration"]["shift_um"].get<double>(), 1.5, 1e-3);
  EXPECT_EQ(result["registration"]["fitted_parameters"], 1);
  EXPECT_LT(result["metrics"]["RMSE"].get<double>(), 1e-4);
  EXPECT_GT(result["metrics_before"]["RMSE"].get<double>(), 1e-2);
  EXPECT_LT(result["metrics"]["reduced_chi_square"].get<double>(), 1e-2);
}

TEST(LineComparison, UnknownUncertaintiesAreNullsOfTheSameLength) {
  LineRequest request;
  request.run = synthetic_run(one_grain);
  request.start = {20e-6, -25e-6, -20e-6};
  request.end = {20e-6, 25e-6, -20e-6};
  request.measured = fs::path(testing::TempDir()) / "synthetic_scan.csv";
  std::ofstream(request.measured) << "Distance (um),Al Wt%,Fe Wt%\n0,50,50\n10,40,60\n20,30,70\n";
  const auto result = compare_line(request);
  EXPECT_EQ(result["measured"]["concentration_u"].size(), 3u);
  EXPECT_TRUE(result["measured"]["concentration_u"][0].is_null());
  EXPECT_TRUE(result["metrics"]["reduced_chi_square"].is_null());
}

/// A line across the synthetic plate against a synthetic measurement.
LineRequest measured_request(const std::string& csv) {
  LineRequest request;
  request.run = synthetic_run(one_grain);
  request.start = {20e-6, -25e-6, -20e-6};
  request.end = {20e-6, 25e-6, -20e-6};
  request.measured = fs::path(testing::TempDir()) / "synthetic_scan.csv";
  std::ofstream(request.measured) << csv;
  return request;
}

bool warned(const nlohmann::json& result, const std::string& name) {
  for (const auto& warning : result["warnings"]) {
    if (warning["name"] == name) {
      return true;
    }
  }
  return false;
}

TEST(LineComparison, HoldsTheWholeBudgetAndV20) {
  const auto result = compare_line(measured_request(
      "Distance (um),Al Wt%,Al Sigma,Fe Wt%\n10,60,1,39\n20,50,1,49\n30,30,1,69\n"));
  EXPECT_EQ(result["compared"]["u"].size(), 3u);
  EXPECT_GT(result["compared"]["u"][1].get<double>(), 0.01 / 0.8965);
  EXPECT_GT(result["uncertainty"]["rms_numerical"].get<double>(), 0);
  EXPECT_NEAR(result["uncertainty"]["rms_reported"].get<double>(), 0.01 / 0.8965, 1e-12);
  EXPECT_EQ(result["vv20"]["E"], result["metrics"]["E"]);
  EXPECT_FALSE(result["vv20"]["complete"].get<bool>());
  EXPECT_TRUE(result["metrics"]["reduced_chi_square"].is_number());
  EXPECT_NEAR(result["compared"]["residual"][0].get<double>(),
              result["compared"]["simulated"][0].get<double>() - 60 / 89.65, 1e-12);
  // Every value is smaller or greater by an amount of its own: the area is at least |E|.
  EXPECT_GE(result["metrics"]["area"].get<double>(),
            std::abs(result["metrics"]["E"].get<double>()) - 1e-12);
}

TEST(LineComparison, NamesAScanShorterThanTheInteractionVolumeAndAMissingSigma) {
  const auto result =
      compare_line(measured_request("Distance (um),Al Wt%,Fe Wt%\n10,60,39\n11,59,40\n12,58,41\n"));
  EXPECT_TRUE(warned(result, "shorter_than_interaction_volume"));
  EXPECT_TRUE(warned(result, "no_uncertainty"));
  EXPECT_TRUE(result["metrics"]["reduced_chi_square"].is_null());
  const auto longer =
      compare_line(measured_request("Distance (um),Al Wt%,Fe Wt%\n10,60,39\n20,59,40\n30,58,41\n"));
  EXPECT_FALSE(warned(longer, "shorter_than_interaction_volume"));
}

TEST(LineComparison, AnEmptySlotStaysPending) {
  const auto result = compare_line(measured_request("position [um],concentration [%]\n"));
  EXPECT_EQ(result["status"], "pending");
  EXPECT_TRUE(result["measured"].is_null());
  EXPECT_NE(result["pending_because"].get<std::string>().find("empty slot"), std::string::npos);
}

TEST(LineComparison, TheLocalMatrixBlursTheAdditiveMoreThanTheSteel) {
  LineRequest request;
  request.run = synthetic_run(one_grain);
  request.start = {20e-6, -25e-6, -20e-6};  // additive at the start, steel at the end
  request.end = {20e-6, 25e-6, -20e-6};
  const auto local = compare_line(request);
  const auto& sigma = local["simulated"]["interaction_sigma_um"];
  EXPECT_NEAR(sigma[0].get<double>() / sigma[200].get<double>(), 7874.0 / 2700, 0.02);
  EXPECT_NEAR(sigma[200].get<double>(), local["interaction"]["sigma_um"].get<double>(), 1e-3);
  EXPECT_NEAR(local["line"]["strip"]["most_depth_um"].get<double>(), 7.14, 0.02);
  request.matrix = Matrix::iron;
  const auto iron_matrix = compare_line(request);
  EXPECT_NEAR(iron_matrix["interaction"]["sigma_most_um"].get<double>(), 1.04, 0.005);
  request.from = Estimate::silicon;  // whose edge is higher: fewer electrons reach it
  EXPECT_LT(compare_line(request)["interaction"]["range_um"].get<double>(),
            iron_matrix["interaction"]["range_um"].get<double>());
}

// A uniform concentration is seen uniform to the very ends of the line, whatever the matrix.
TEST(LineComparison, TheEndsOfTheLineAreNoEndsOfTheMetal) {
  LineRequest request;
  request.run = synthetic_run(one_grain);
  request.start = {20e-6, -4e-6, -20e-6};
  request.end = {20e-6, 20e-6, -20e-6};
  const double from_here = compare_line(request)["simulated"]["concentration_seen"][0];
  request.start[1] = -28e-6;  // the same place, 24 um from the start
  const double from_before = compare_line(request)["simulated"]["concentration_seen"][96];
  EXPECT_NEAR(from_here, from_before, 2e-4);
}

TEST(LineComparison, SaysWhatIsWrong) {
  LineRequest request;
  request.run = synthetic_run([](const Point&) { return false; });
  request.grain = Direction::depth;
  EXPECT_THROW(compare_line(request), NoGrain);
  request.run = "nowhere/run.h5";
  EXPECT_THROW(compare_line(request), InputError);
  request.run = "validation/linescan/line_comparison_test.cpp";
  EXPECT_THROW(compare_line(request), InputError);
}

}  // namespace
}  // namespace meltproof::validation

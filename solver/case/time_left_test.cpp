// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/case/time_left.hpp"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace meltproof::solver {
namespace {

/// Melt that grows to 2e-12 m3 in half of a millisecond and stays so.
std::vector<TimeLeft::Melt> growing() {
  std::vector<TimeLeft::Melt> melt;
  for (int k = 0; k <= 100; ++k) {
    melt.push_back({k * 1e-5, std::min(k, 50) * 4e-14});
  }
  return melt;
}

}  // namespace

TEST(TimeLeft, FollowsTheMeltThatIsStillToCome) {
  TimeLeft left(growing());
  EXPECT_FALSE(left.seconds(0));
  // 3e5 s a second without melt, and 1e18 a cubic metre beside: the first tenth of a millisecond.
  const auto rate = [](double volume) { return 3e5 + 1e18 * volume; };
  for (int k = 1; k <= 10; ++k) {
    const double volume = (k - 0.5) * 4e-14;
    left.add(1e-5, 1e-5 * rate(volume), volume);
  }
  const double expected = 0.4e-3 * rate(1.2e-12) + 0.5e-3 * rate(2e-12);
  ASSERT_TRUE(left.seconds(1e-4));
  EXPECT_NEAR(*left.seconds(1e-4) / expected, 1, 1e-9);
  EXPECT_NEAR(*left.seconds(0.75e-3) / (0.25e-3 * rate(2e-12)), 1, 1e-9);
  EXPECT_EQ(*left.seconds(1e-3), 0);
}

TEST(TimeLeft, CostsAreNeverNegative) {
  TimeLeft falling(growing()), steep(growing());
  for (int k = 1; k <= 5; ++k) {
    falling.add(1e-5, 10 - k, k * 1e-13);
    steep.add(1e-5, k - 1, k * 1e-13);
  }
  EXPECT_NEAR(*falling.seconds(0.9e-3), 0.1e-3 / 1e-5 * 7, 1e-6);
  EXPECT_GT(*steep.seconds(0.9e-3), 0);
}

TEST(TimeLeft, AHistoryThatIsNoneIsRefusedWithLineAndColumn) {
  const auto path = std::filesystem::temp_directory_path() / "meltproof_history_test.csv";
  const auto refused = [&](const std::string& content) -> std::string {
    std::ofstream(path) << content;
    try {
      read_melt(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refused("time [us],peak [K]\n").find("liquid_volume [um3]"), std::string::npos);
  EXPECT_NE(refused("time [us],liquid_volume [um3]\n1,2\n3,x\n").find("line 3"), std::string::npos);
  EXPECT_NE(refused("time [us],liquid_volume [um3]\n1\n").find("line 2"), std::string::npos);
  EXPECT_EQ(refused("time [us],liquid_volume [um3]\n1,2\n"), "");
  std::filesystem::remove(path);
  EXPECT_THROW(read_melt(path), InputError);
}

}  // namespace meltproof::solver

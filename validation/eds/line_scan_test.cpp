// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/line_scan.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "validation/eds/concentration.hpp"

namespace meltproof::validation {
namespace {

/// Every scan in this file is synthetic: its numbers are made up to exercise the reader.
LineScan read(const std::string& text) {
  const auto path = std::filesystem::path(testing::TempDir()) / "synthetic_scan.csv";
  std::ofstream(path, std::ios::binary) << text;
  return read_line_scan(path);
}

std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& problem) {
    return problem.what();
  }
  return "";
}

TEST(LineScan, CommaSeparatedWithMicroSignAndPreamble) {
  const auto scan = read(
      "\xEF\xBB\xBFProject: synthetic\r\nAcceleration: 30 kV\r\n\r\n"
      "Distance (\xC2\xB5m),Al Wt%,Al Wt% Sigma,Si Wt%,Fe Wt%\r\n"
      "0,44.825,0.5,5,50.175\r\n0.5,8.965,0.2,1,90\r\n1,0,0.1,0,80\r\n");
  ASSERT_EQ(scan.position.size(), 3u);
  EXPECT_DOUBLE_EQ(scan.position[1], 0.5e-6);
  EXPECT_FALSE(scan.of_atoms);
  EXPECT_EQ(scan.elements.size(), 3u);
  EXPECT_NEAR(scan.total[0], 1, 1e-12);
  EXPECT_EQ(scan.flagged, std::vector<std::size_t>{2});  // 80 %
  const auto profile = concentration_from_aluminium(scan);
  EXPECT_NEAR(profile.concentration[0], 0.5, 1e-12);
  EXPECT_NEAR(profile.concentration[1], 0.1, 1e-12);
  EXPECT_NEAR(profile.uncertainty[0], 0.005 / 0.8965, 1e-12);
  EXPECT_NEAR(concentration_from_silicon(scan, 0).concentration[0], 0.5, 1e-12);
}

TEST(LineScan, SemicolonDecimalCommaNanometreAndLatinOne) {
  const auto nm = read("Position [nm];Al [wt.%];Fe [wt.%]\n0,0;1,5;98,5\n250,5;2,5;97,5\n");
  EXPECT_DOUBLE_EQ(nm.position[1], 250.5e-9);
  EXPECT_DOUBLE_EQ(nm.elements.at("Al").fraction[1], 0.025);
  const auto um = read("Distance \xB5m;Al wt%\n0;1\n1;2\n");
  EXPECT_DOUBLE_EQ(um.position[1], 1e-6);
}

TEST(LineScan, TabsTwoHeaderLinesAndATotal) {
  const auto scan = read(
      "Line scan\nDistance\tAl\tFe\tTotal\nnm\twt%\twt%\twt%\n0\t10\t80\t98\n10\t10\t80\t110\n");
  EXPECT_DOUBLE_EQ(scan.position[1], 1e-8);
  EXPECT_DOUBLE_EQ(scan.total[0], 0.98);
  EXPECT_EQ(scan.flagged, std::vector<std::size_t>{1});
  EXPECT_EQ(scan.elements.count("Total"), 0u);
}

TEST(LineScan, AtomPercentBecomesMass) {
  const auto scan = read("Distance um,Al At%,Fe At%,Fe counts\n0,67.42,32.58,5000\n1,0,100,9000\n");
  EXPECT_TRUE(scan.of_atoms);
  EXPECT_NEAR(concentration_from_aluminium(scan).concentration[0] * 0.8965, 0.5, 1e-4);
}

TEST(LineScan, TakesMassIfBothAreThere) {
  const auto scan = read("Distance um,Al At%,Fe At%,Al Wt%,Fe Wt%\n0,67,33,50,50\n1,0,100,0,100\n");
  EXPECT_FALSE(scan.of_atoms);
  EXPECT_DOUBLE_EQ(scan.elements.at("Al").fraction[0], 0.5);
}

TEST(LineScan, TheKindMayStandInThePreamble) {
  EXPECT_TRUE(
      read("Quantification in atomic percent\nDistance um,Al,Fe\n0,1,99\n1,2,98\n").of_atoms);
}

TEST(LineScan, EveryFaultIsASentenceOfItsOwn) {
  EXPECT_NE(refusal("no table here\n").find("no row of numbers"), std::string::npos);
  EXPECT_NE(refusal(std::string("a\0b", 3)).find("no text"), std::string::npos);
  EXPECT_NE(refusal("Distance,Al Wt%\n0,1\n1,2\n").find("has no unit"), std::string::npos);
  EXPECT_NE(refusal("Place um,Al Wt%\n0,1\n1,2\n").find("no column is a position"),
            std::string::npos);
  EXPECT_NE(refusal("Distance um,Al\n0,1\n1,2\n").find("wt% or at%"), std::string::npos);
  EXPECT_NE(refusal("Distance um,Signal\n0,1\n1,2\n").find("names an element"), std::string::npos);
  EXPECT_NE(refusal("Distance um,Al Wt%\n0,1\n0,2\n").find(":3: the position"), std::string::npos);
  EXPECT_NE(refusal("Distance um,Al Wt%\n0,1\n1,-\n2,3\n").find(":3: \"-\""), std::string::npos);
  EXPECT_NE(refusal("Distance um,Al Wt%\n0,1\n1,2,3\n").find(":3: found 3"), std::string::npos);
  const auto scan = read("Distance um,Fe Wt%\n0,1\n1,2\n");
  EXPECT_THROW(concentration_from_aluminium(scan), InputError);
  EXPECT_THROW(read_line_scan("nowhere.csv"), InputError);
}

}  // namespace
}  // namespace meltproof::validation

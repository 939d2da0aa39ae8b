// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/csv_export.hpp"

#include <cmath>

#include "validation/eds/column_words.hpp"
#include "validation/eds/concentration.hpp"
#include "validation/eds/eds_test_files.hpp"
#include "validation/eds/formats.hpp"

namespace meltproof::validation {
namespace {

/// Every scan in this file is synthetic: styles of the vendors' exports, made-up numbers.
LineScan read(const std::string& text) {
  return read_line_scan(synthetic_file("styles.csv", text));
}

TEST(CsvExport, InTheStyleOfAztec) {
  const auto scan = read(
      "\"Line Data 1\",\"Acceleration voltage 30 kV\"\r\n\r\n"
      "\"Point\",\"Distance (\xC2\xB5m)\",\"Al Wt%\",\"Al Wt% Sigma\",\"Fe Wt%\",\"Fe Wt% "
      "Sigma\"\r\n"
      "\"Spectrum 1\",0.0,20,0.3,79,0.5\r\n\"Spectrum 2\",0.25,10,0.2,89,0.6\r\n");
  EXPECT_EQ(scan.format, "CSV export");
  EXPECT_DOUBLE_EQ(scan.position[1], 0.25e-6);
  EXPECT_EQ(*scan.voltage, 30);
  EXPECT_DOUBLE_EQ(scan.elements.at("Fe").uncertainty[1], 0.006);
  EXPECT_EQ(scan.elements.size(), 2u);
}

TEST(CsvExport, InTheStyleOfEspritWithUtf16AndBothQuantifications) {
  const std::string text =
      "Massenprozent\r\nAbstand [\xC2\xB5m]\tAl-K norm. [wt.%]\tAl-K unn. [wt.%]\tAl-K Fehler\t"
      "Al-K error [wt.%] (3 Sigma)\tFe-K unn. [wt.%]\tFe-K rel. error [%] (1 Sigma)\t\r\n"
      "0,0\t50,0\t49,0\t0\t3,0\t48,0\t10,0\t\r\n0,5\t30,0\t29,0\t0\t1,5\t69,0\t10,0\t\r\n";
  std::string wide = "\xFF\xFE";
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c == 0xC2) {
      continue;  // the micro sign is one character of UTF-16
    }
    wide += static_cast<char>(c);
    wide += '\0';
  }
  const auto scan = read(wide);
  EXPECT_DOUBLE_EQ(scan.position[1], 0.5e-6);
  EXPECT_DOUBLE_EQ(scan.elements.at("Al").fraction[0], 0.49);  // rather not normalised
  EXPECT_DOUBLE_EQ(scan.elements.at("Al").uncertainty[0], 0.01);
  EXPECT_DOUBLE_EQ(scan.elements.at("Fe").uncertainty[1], 0.069);  // a tenth of the value
}

TEST(CsvExport, InTheStyleOfEdaxWithCoordinatesAndCounts) {
  const auto scan = read(
      "kV: 20\nX (mm),Y (mm),AlK (wt%),AlK +/- (wt%),AlK counts,AlK background counts,FeK (wt%)\n"
      "1.000,2.000,20,0.5,400,50,79\n1.003,2.004,10,0.4,100,0,89\n");
  EXPECT_NEAR(scan.position[1], 5e-6, 1e-12);
  EXPECT_DOUBLE_EQ(scan.elements.at("Al").uncertainty[1], 0.004);
  EXPECT_EQ(scan.elements.at("Al").background[0], 50);
  EXPECT_NEAR(concentration_from_aluminium(scan).counting[0], 0.2 * std::sqrt(500.0) / 400 / 0.8965,
              1e-12);
}

TEST(CsvExport, AtomPercentWithGreekLinesAndErrors) {
  const auto scan = read(
      "Distance \xC2\xB5m;Al K\xCE\xB1 at%;Al K\xCE\xB1 at% error;Fe K\xCE\xB1 at%\n0;67,42;0,5;"
      "32,58\n1;0;0,1;100\n");
  EXPECT_TRUE(scan.of_atoms);
  EXPECT_DOUBLE_EQ(scan.elements.at("Al").uncertainty[0], 0.005);
  EXPECT_NEAR(concentration_from_aluminium(scan).concentration[0] * 0.8965, 0.5, 1e-4);
}

TEST(CsvExport, AConcentrationThatTheFileStatesItself) {
  const auto scan =
      read("# synthetic\nposition [um],concentration [%],concentration_u [%]\n0,60,2\n1,40,2\n");
  ASSERT_TRUE(scan.alloy);
  EXPECT_DOUBLE_EQ(scan.alloy->fraction[1], 0.4);
  EXPECT_DOUBLE_EQ(scan.alloy->uncertainty[1], 0.02);
  EXPECT_TRUE(scan.flagged.empty());
  EXPECT_FALSE(scan.empty_slot);
  EXPECT_TRUE(read("# synthetic\nposition [um],concentration [%]\n").empty_slot);
  EXPECT_REFUSED(read("position [um],concentration [g]\n0,60\n1,40\n"), "has the unit \"g\"");
}

TEST(CsvExport, EmptyCellsAtTheEndAreNotKnown) {
  const auto scan =
      read("position [um],concentration [%],concentration_u [%]\n0,60,\n1,40,2\n2,,\n");
  EXPECT_TRUE(std::isnan(scan.alloy->uncertainty[0]));
  EXPECT_DOUBLE_EQ(scan.alloy->uncertainty[1], 0.02);
  EXPECT_EQ(scan.flagged, std::vector<std::size_t>{2});
  EXPECT_REFUSED(read("Distance (um),Al Wt%,Fe Wt%\n0,,80\n1,20,80\n"), "is no number");
}

TEST(CsvExport, AColumnWithTheWrongUnitIsNamed) {
  const auto scan = read("Distance (um),Al (ppm),Al Wt%,Fe Wt%\n0,1,20,80\n1,1,10,90\n");
  ASSERT_FALSE(scan.remarks.empty());
  EXPECT_NE(scan.remarks[0].find("\"Al (ppm)\" is in \"ppm\""), std::string::npos);
  EXPECT_REFUSED(read("Distance (um),Al (ppm)\n0,1\n1,1\n"), "is in \"ppm\", which is neither");
  EXPECT_REFUSED(read("Distance (px),Al Wt%\n0,1\n1,1\n"), "has no unit of length");
  const auto fractions = read("Distance (um),Al Wt%,Fe Wt%\n0,0.2,0.8\n1,0.1,0.9\n");
  EXPECT_NE(fractions.remarks[0].find("seem to hold fractions"), std::string::npos);
}

TEST(CsvExport, NormalisedTotalsAreRemarkedOn) {
  const auto scan = read("Distance (um),Al Wt%,Fe Wt%\n0,20,80\n1,10,90\n");
  ASSERT_EQ(scan.remarks.size(), 1u);
  EXPECT_NE(scan.remarks[0].find("were normalised"), std::string::npos);
  EXPECT_TRUE(read("Distance (um),Al Wt%,Fe Wt%\n0,20,79\n1,10,90\n").remarks.empty());
}

TEST(ColumnWords, SayWhatAColumnHolds) {
  EXPECT_EQ(read_column_header("Al Wt%").role, Role::fraction);
  EXPECT_EQ(read_column_header("Al-K").element, "Al");
  EXPECT_EQ(read_column_header("Al (wt%)").share, Share::mass);
  EXPECT_EQ(read_column_header("Al sigma").role, Role::uncertainty);
  EXPECT_EQ(read_column_header("Al error (2 sigma)").coverage, 2);
  EXPECT_EQ(read_column_header("Al Ka1 cps").role, Role::other);
  EXPECT_EQ(read_column_header("Total Wt%").role, Role::total);
  EXPECT_TRUE(read_column_header("Al norm. C [wt.%]").normalised);
  EXPECT_FALSE(read_column_header("Al unn. C [wt.%]").normalised);
}

}  // namespace
}  // namespace meltproof::validation

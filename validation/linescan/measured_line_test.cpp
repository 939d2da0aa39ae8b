// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/linescan/measured_line.hpp"

#include <algorithm>

#include "validation/eds/eds_test_files.hpp"
#include "validation/linescan/line_comparison.hpp"
#include "validation/linescan/line_options.hpp"
#include "validation/linescan/spectrum_report.hpp"
#include "validation/linescan/synthetic_track.hpp"

namespace meltproof::validation {
namespace {

/// Every measurement in this file is synthetic.
MeasuredRequest request(const std::string& text) {
  MeasuredRequest wanted;
  wanted.path = synthetic_file("measured.csv", text);
  return wanted;
}

template <class List>
bool holds(const List& warnings, const std::string& name) {
  return std::any_of(warnings.begin(), warnings.end(),
                     [&](const auto& warning) { return warning.name == name; });
}

TEST(MeasuredLine, GivesTheThreeEstimatesBesideEachOther) {
  const auto line =
      read_measured_line(request("Distance (um),Al Wt%,Al Sigma,Si Wt%,Si Sigma,Fe Wt%,Fe Sigma\n"
                                 "0,44.8,0.4,5.2,0.2,50,0.5\n1,9,0.2,1.4,0.1,88,0.8\n"));
  EXPECT_NEAR(line.estimates["Al"]["concentration"][0].get<double>(), 0.4997, 1e-4);
  EXPECT_NEAR(line.estimates["Si"]["concentration"][0].get<double>(), 0.5013, 5e-4);
  EXPECT_TRUE(line.estimates["Si"]["base_assumed"].get<bool>());
  EXPECT_EQ(line.estimates["least_squares"]["covariance"][0].size(), 3u);
  EXPECT_EQ(line.profile.concentration[0], line.estimates["Al"]["concentration"][0]);
  EXPECT_TRUE(line.agreement.contains("Al_Si"));
  EXPECT_FALSE(holds(line.warnings, "estimates_disagree"));
  EXPECT_FALSE(holds(line.warnings, "no_uncertainty"));
}

TEST(MeasuredLine, SaysWhenAluminiumAndSiliconContradict) {
  const auto line =
      read_measured_line(request("Distance (um),Al Wt%,Al Sigma,Si Wt%,Si Sigma,Fe Wt%,Fe Sigma\n"
                                 "0,44.8,0.4,9,0.2,46,0.5\n1,9,0.2,4,0.1,86,0.8\n"));
  EXPECT_TRUE(holds(line.warnings, "estimates_disagree"));
  EXPECT_TRUE(holds(line.warnings, "no_mixture"));
}

TEST(MeasuredLine, NamesWhatIsMissingOrOdd) {
  const auto line = read_measured_line(
      request("Beam 15 kV\nDistance (um),Al Wt%,Fe Wt%\n0,44.8,55\n1,9,90\n2,9,60\n"));
  EXPECT_TRUE(holds(line.warnings, "no_uncertainty"));
  EXPECT_TRUE(holds(line.warnings, "voltage"));
  EXPECT_TRUE(holds(line.warnings, "export"));  // a total of 69 %
  EXPECT_REFUSED(
      read_measured_line(request("Distance (um),Al Wt%,Fe Wt%\n0,40,30\n1,9,30\n2,9,60\n")),
      "every point has a total outside");
}

TEST(MeasuredLine, APointThatIsNotComparedNeedsNoUncertainty) {
  const auto line = read_measured_line(
      request("position [um],concentration [%],concentration_u [%]\n0,60,2\n1,,\n2,40,2\n"));
  EXPECT_FALSE(holds(line.warnings, "zero_uncertainty"));
  const auto missing = read_measured_line(
      request("position [um],concentration [%],concentration_u [%]\n0,60,2\n1,50,\n2,40,2\n"));
  EXPECT_TRUE(holds(missing.warnings, "zero_uncertainty"));
}

TEST(SpectrumReport, ShowsTheVendorsCompositionAndWindows) {
  MeasuredRequest wanted;
  wanted.path = vendor_file("bruker_nano.spx");
  if (!std::filesystem::exists(wanted.path)) {
    GTEST_SKIP() << "the vendors' sample files are not beside this checkout";
  }
  const auto text = describe_export(wanted);
  EXPECT_NE(text.find("S 26.38 wt% (41.7"), std::string::npos) << text;
  EXPECT_NE(text.find("total 95.05 %"), std::string::npos);
  EXPECT_NE(text.find("4096 channels"), std::string::npos);
  EXPECT_NE(text.find("not a composition"), std::string::npos);
}

TEST(LineOptions, EveryFaultNamesItsOption) {
  TypedLine typed;
  typed.run = "run.h5";
  EXPECT_REFUSED(understand(typed), "which line?");
  typed.grain = "depth";
  EXPECT_NO_THROW(understand(typed));
  const auto with = [&](std::string TypedLine::*option, const std::string& value) {
    TypedLine changed = typed;
    changed.*option = value;
    understand(changed);
  };
  EXPECT_REFUSED(with(&TypedLine::run, ""), "which run?");
  EXPECT_REFUSED(with(&TypedLine::width, "-1 um"), "--width");
  EXPECT_REFUSED(with(&TypedLine::depth, "1 kg"), "--depth");
  EXPECT_REFUSED(with(&TypedLine::map_start, "1 um, 2 um"), "both --map-start and --map-end");
  EXPECT_REFUSED(with(&TypedLine::landmark, "1 um"), "--landmark: \"1 um\" holds 1 lengths");
  EXPECT_REFUSED(with(&TypedLine::base, "Fe 50 %"), "--base: the shares add to 50 %");
  EXPECT_REFUSED(with(&TypedLine::base, "Xx 50 %"), "--base: \"Xx 50 %\"");
  EXPECT_REFUSED(with(&TypedLine::element, "Si"), "--base-silicon");
  typed.base = "Fe 66 %, Cr 17 %, Ni 12 %, Mo 2.5 %, Mn 1.5 %, Si 0.5 %";
  typed.landmark = "half-height";
  EXPECT_NEAR(understand(typed).base.at("Si"), 0.005, 1e-12);
  EXPECT_TRUE(understand(typed).bounds.landmark->half_height);
}

TEST(LineOptions, TheHelpHasAnExampleForEachFormat) {
  const auto help = line_scan_help();
  for (const char* word : {"AZtec", "Esprit", "EDAX", "H5OINA", "TIFF", "SPX", ".msa",
                           "--map-width", "--point-spacing", "--spectrum"}) {
    EXPECT_NE(help.find(word), std::string::npos) << word;
  }
}

}  // namespace
}  // namespace meltproof::validation

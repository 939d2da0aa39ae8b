// SPDX-License-Identifier: GPL-3.0-or-later
// Synthetic SFMOV files with the published calibration of a real SC8200: band 3 to 4.9 um, made for
// -20 to 55 Celsius, which lie at 2634 and 13319 counts.
#include "imaging/recording/sfmov.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "imaging/recording/formats.hpp"
#include "imaging/recording/sfmov_include.hpp"
#include "imaging/recording/synthetic_files.hpp"
#include "imaging/recording/test_folder.hpp"

namespace meltproof::imaging {
namespace {

TEST(SfmovInclude, GivesTheTemperaturesThatTheCameraWasCalibratedFor) {
  const auto include = parse_sfmov_include(synthetic::sfmov_include());
  ASSERT_TRUE(include.calibration);
  const auto& c = *include.calibration;
  // The file's own limits of radiance, 2.37031799770193e-5 and 4.02841513277963e-4 W cm-2 sr-1,
  // are exactly -20 and 55 Celsius by its constants R, B, F.
  SfmovCalibration direct = c;
  direct.radiance = {0, 1};
  direct.lowest_count.reset();
  direct.highest_count.reset();
  EXPECT_NEAR(direct.temperature(2.37031799770193e-5) - 273.15, -20, 1e-3);
  EXPECT_NEAR(direct.temperature(4.02841513277963e-4) - 273.15, 55, 1e-3);
  // From the counts the polynomial comes within a kelvin of them: it is a fit of second order.
  EXPECT_NEAR(c.temperature(2634) - 273.15, -20, 1);
  EXPECT_NEAR(c.temperature(13319) - 273.15, 55, 0.1);
  EXPECT_EQ(c.temperature(13400), c.temperature(13319));
  EXPECT_DOUBLE_EQ(include.frame_rate, 30);
  EXPECT_DOUBLE_EQ(include.integration_time, 6.68608e-3);
  EXPECT_DOUBLE_EQ(include.constants.at("band_upper_um"), 4.9);
}

TEST(SfmovInclude, PrefersThePolynomialOfTheTemperature) {
  const auto include = parse_sfmov_include(
      "nfcC0_0 1\nnfcC1_0 2\nnfcTempC0_0 10\nnfcTempC1 0.5\nnfcTempC2_0 0.25\n");
  ASSERT_TRUE(include.calibration);
  // L = 1 + 2 * 3 = 7; t = 10 + 3.5 + 12.25.
  EXPECT_DOUBLE_EQ(include.calibration->temperature(3), 25.75 + 273.15);
}

TEST(SfmovInclude, HasNoCalibrationWhereItIsIncompleteOrFalls) {
  EXPECT_FALSE(parse_sfmov_include("nfcC0_0 1\nnfcC1_0 2\n").calibration);
  EXPECT_FALSE(parse_sfmov_include("nfcTempC1_0 1\nnfcR_0 1\nnfcB_0 1\n").calibration);
  EXPECT_FALSE(parse_sfmov_include("nfcC1_0 1\nnfcTempC1_0 -1\nnfcMinCounts_0 1\n"
                                   "nfcMaxCounts_0 9\n")
                   .calibration);
  EXPECT_FALSE(parse_sfmov_include("").calibration);
}

TEST(Sfmov, ReadsCountsWithoutAnIncludeFile) {
  const TestFolder folder;
  const auto first = synthetic::scene(9, 5, 0), second = synthetic::scene(9, 5, 1);
  const auto recording =
      open_recording(folder.file("a.sfmov", synthetic::sfmov({first, second}, "UInt16", 2)));
  EXPECT_EQ(recording.header().format, "FLIR SFMOV");
  ASSERT_EQ(recording.header().frames, 2u);
  EXPECT_EQ(recording.header().frames_lost, 0u);
  EXPECT_EQ(recording.header().saturation, 16383);
  EXPECT_EQ(recording.header().quantity, SignalQuantity::counts);
  EXPECT_EQ(recording.frame(1).values,
            std::vector<float>(second.counts.begin(), second.counts.end()));
  EXPECT_EQ(recording.frame(0).status[0], PixelStatus::saturated);  // 17000 of 14 bits
  EXPECT_TRUE(says(recording.header().notes.back(), "no .inc file"));
}

TEST(Sfmov, TurnsCountsIntoTemperaturesWithItsIncludeFile) {
  const TestFolder folder;
  folder.file("rec.inc", synthetic::sfmov_include());  // named in the header
  synthetic::Picture p{3, 1, {2634, 13318, 13319}};
  const auto recording = open_recording(folder.file("b.sfmov", synthetic::sfmov({p}, "UInt16", 1)));
  const auto& h = recording.header();
  EXPECT_EQ(h.quantity, SignalQuantity::temperature);
  EXPECT_EQ(h.unit, "K");
  EXPECT_EQ(h.frame_rate, 30);
  ASSERT_EQ(h.companions.size(), 1u);
  EXPECT_EQ(h.companions[0].filename(), "rec.inc");
  const auto f = recording.frame(0);
  EXPECT_EQ(f.counts, (std::vector<float>{2634, 13318, 13319}));
  EXPECT_EQ(f.status,
            (std::vector{PixelStatus::under_range, PixelStatus::good, PixelStatus::saturated}));
  EXPECT_NEAR(f.values[1] - 273.15, 55, 0.15);
}

TEST(Sfmov, ReadsFloatsAndSaysThatTheirUnitIsUnknown) {
  const TestFolder folder;
  synthetic::Picture p{2, 1, {100, 103}};
  const auto recording = open_sfmov(folder.file("c.sfmov", synthetic::sfmov({p}, "Flt32", 1)));
  EXPECT_EQ(recording.frame(0).values, (std::vector<float>{25, 25.75}));
  EXPECT_TRUE(says(recording.header().notes[0], "does not say what they are"));
}

TEST(Sfmov, CountsWhatIsLostAndWhatIsMore) {
  const TestFolder folder;
  const auto p = synthetic::scene(9, 5, 0);
  const std::string whole = synthetic::sfmov({p, p, p}, "uint16", 5);
  const auto cut = open_sfmov(folder.file("cut.sfmov", whole.substr(0, whole.size() - 1)));
  EXPECT_EQ(cut.header().frames, 2u);
  EXPECT_EQ(cut.header().frames_lost, 3u);
  const auto more = open_sfmov(folder.file("more.sfmov", synthetic::sfmov({p, p, p}, "uint16", 2)));
  EXPECT_EQ(more.header().frames, 3u);
  EXPECT_TRUE(says(more.header().notes[0], "announces 2 frames, but 3"));
}

TEST(Sfmov, RefusesWithASentence) {
  const TestFolder folder;
  const auto refused = [&](const std::string& bytes) {
    const auto path = folder.file("bad.sfmov", bytes);
    return refusal_of([&] { open_sfmov(path); });
  };
  EXPECT_TRUE(says(refused("xPixls 3\nyPixls 4\nDaType Flt32\n"), "no line DATA"));
  EXPECT_TRUE(says(refused("xPixls 3\nyPixls 4\nDaType Complex\nDATA\n"), "DaType \"complex\""));
  EXPECT_TRUE(says(refused("xPixls -3\nyPixls 4\nDaType word\nDATA\n"), "xPixls \"-3\""));
  EXPECT_TRUE(
      says(refused("xPixls 99999999999\nyPixls 4\nDaType word\nDATA\n"), "more than any camera"));
  EXPECT_TRUE(says(refused("xPixls 3\nyPixls 4\nDaType word\nDATA\n\1"), "first frame is whole"));
}

}  // namespace
}  // namespace meltproof::imaging

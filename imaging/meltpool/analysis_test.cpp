// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/analysis.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "imaging/recording/formats.hpp"

namespace meltproof::imaging {
namespace {

const std::filesystem::path samples = "../shared/samples";

#define NEED_SAMPLE(name)                         \
  if (!std::filesystem::exists(samples / (name))) \
  GTEST_SKIP() << "the sample " << (name) << " is not here"

using Field = std::function<double(std::size_t frame, double x, double y)>;

/// A synthetic recording whose values are computed when they are read.
Recording synthetic(std::size_t width, std::size_t height, std::size_t frames, Field field) {
  RecordingHeader header;
  header.path = "synthetic";
  header.width = width;
  header.height = height;
  header.frames = frames;
  header.synthetic = "computed by a test";
  return {header, [width, field = std::move(field)](std::size_t index, Frame& frame) {
            for (std::size_t i = 0; i < frame.values.size(); ++i)
              frame.values[i] = static_cast<float>(
                  field(index, static_cast<double>(i % width), static_cast<double>(i / width)));
          }};
}

Analysis analysed(const Recording& recording, const LevelRequest& request = {}) {
  return analyse(recording, request, ScanDirection::right, {});
}

TEST(Samples, WithoutAMeltPoolAreSaidToHaveNoneAndWhy) {
  for (const char* name :
       {"cedip_pyradi_PyradiSampleMWIR.ptw", "flir_flirpy_example_radiometric.tiff"}) {
    NEED_SAMPLE(name);
    const auto a = analysed(open_recording(samples / name));
    EXPECT_FALSE(a.found) << name;
    EXPECT_NE(a.reason.find("standard deviations of the background"), std::string::npos)
        << a.reason;
  }
  NEED_SAMPLE("flir_thermimage_SampleSEQ.seq");
  const auto a = analysed(open_recording(samples / "flir_thermimage_SampleSEQ.seq"));
  EXPECT_FALSE(a.found);
  EXPECT_NE(a.reason.find("38.3 degC"), std::string::npos) << a.reason;
  EXPECT_NE(a.reason.find("1683 K"), std::string::npos) << a.reason;
}

TEST(Samples, TheMeltPoolOfNistIsFoundWithoutBeingTold) {
  NEED_SAMPLE("meltpool_sample_img.bmp");
  const auto recording = open_recording(samples / "meltpool_sample_img.bmp");
  const auto a = analysed(recording);
  ASSERT_TRUE(a.found);
  EXPECT_EQ(a.level.kind, LevelKind::contrast);
  EXPECT_TRUE(a.frames[0].complete);
  // Between the regions of 139 and 100 pixels that the README states for the levels 80 and 128.
  EXPECT_GT(*a.level.value, 80);
  EXPECT_LT(*a.level.value, 128);
  EXPECT_LT(a.frames[0].region.pixels, 139u);
  EXPECT_GT(a.frames[0].region.pixels, 100u);
}

TEST(Samples, TheMeltPoolOfNistHasThePublishedPixelsAtGivenLevels) {
  NEED_SAMPLE("meltpool_sample_img.bmp");
  const auto recording = open_recording(samples / "meltpool_sample_img.bmp");
  const std::pair<double, std::size_t> published[] = {{40, 214}, {80, 139}, {128, 100}, {200, 66}};
  for (const auto& [level, pixels] : published) {
    const auto a = analysed(recording, {.level = level,
                                        .reference_temperature = {},
                                        .emissivity = {},
                                        .emissivity_liquid = {},
                                        .transmission = {}});
    ASSERT_TRUE(a.found);
    EXPECT_EQ(a.frames[0].region.pixels, pixels);
    // A count of pixels scatters around the area by about the root of the number on the edge.
    EXPECT_NEAR(a.frames[0].area, static_cast<double>(pixels),
                0.6 * std::sqrt(static_cast<double>(pixels)));
    if (level == 128) {
      const auto& r = a.frames[0].region;
      EXPECT_NEAR(r.centroid.x, 51.91, 0.2);
      EXPECT_NEAR(r.centroid.y, 66.97, 0.2);
      // The box of pixels is x 47..56, y 61..74; the contour ends less than a pixel outside it.
      EXPECT_TRUE(r.x.low > 46 && r.x.low <= 47 && r.x.high >= 56 && r.x.high < 57);
      EXPECT_TRUE(r.y.low > 60 && r.y.low <= 61 && r.y.high >= 74 && r.y.high < 75);
    }
  }
}

/// `floor` counts with a noise of 5, and an ellipse (half axes a, b) with smooth edges `height`
/// above.
Recording scene(double height, double a, double b, double floor = 100, std::uint64_t seed = 7) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 5);
  std::vector<double> noise(60 * 40);
  for (auto& v : noise) v = normal(random);
  return synthetic(60, 40, 1, [=](std::size_t, double x, double y) {
    const double d = std::hypot((x - 30.3) / a, (y - 19.6) / b);
    return floor + noise[static_cast<std::size_t>(y) * 60 + static_cast<std::size_t>(x)] +
           height / (1 + std::pow(d, 6));
  });
}

TEST(ContrastRule, FindsABrightCompactRegionAndItsSize) {
  const auto a = analysed(scene(5000, 9, 5));
  ASSERT_TRUE(a.found);
  // The scene is 100 + 5000 / (1 + d^6), so the ellipse at the level is known.
  const double d = std::pow(5000 / (*a.level.value - 100) - 1, 1.0 / 6);
  EXPECT_NEAR(a.length.mean, 2 * 9 * d, 0.2);
  EXPECT_NEAR(a.depth.mean, 2 * 5 * d, 0.2);
  EXPECT_GT(*a.level.value, 1000);
  EXPECT_LT(*a.level.value, 4000);
}

TEST(ContrastRule, RefusesNoiseFaintRegionsAndSinglePixels) {
  EXPECT_FALSE(analysed(scene(0, 9, 5)).found);
  const auto faint = analysed(scene(60, 9, 5));
  EXPECT_FALSE(faint.found);
  EXPECT_NE(faint.reason.find("standard deviations"), std::string::npos) << faint.reason;
  // Well above the noise, but hardly brighter than what surrounds it: a warm body, no molten metal.
  const auto warm = analysed(scene(500, 9, 5, 3000));
  EXPECT_FALSE(warm.found);
  EXPECT_NE(warm.reason.find("times the signal of the background"), std::string::npos)
      << warm.reason;
  const auto pixel = analysed(scene(8000, 0.4, 0.4));
  EXPECT_FALSE(pixel.found) << pixel.level.how;
  EXPECT_FALSE(
      analysed(synthetic(20, 20, 2, [](std::size_t, double, double) { return 77.0; })).found);
}

TEST(ContrastRule, RefusesARaggedRegion) {
  // A bright frame around a dark middle: connected, large, bright, and no melt pool.
  const auto a = analysed(synthetic(60, 40, 1, [](std::size_t, double x, double y) {
    const double d = std::max(std::abs(x - 30) / 22, std::abs(y - 20) / 14);
    return std::abs(d - 1) < 0.05 ? 5000.0 : 100.0 + std::fmod(7 * x + 13 * y, 11);
  }));
  EXPECT_FALSE(a.found);
  EXPECT_NE(a.reason.find("ragged"), std::string::npos) << a.reason;
}

/// Rosenthal's pool crossing the camera of the paper: 96 x 40 px of 17.6 um at 9762.5 Hz, 0.375
/// m/s.
constexpr double pixel_size = 17.6e-6, speed = 0.375, rate = 9762.5;
Recording passing_pool(double dark = 900) {
  Radiometry camera{
      .transmission = 0.313, .emissivity = 0.3, .dark = dark, .integration_time = 20e-6};
  camera.gain = 8000 / (signal(camera, 2500) - dark);
  const auto table = std::make_shared<BandTable>(camera.band_lower, camera.band_upper);
  auto recording = synthetic(96, 40, 60, [=](std::size_t frame, double x, double y) {
    const double source = -0.1e-3 + speed * static_cast<double>(frame) / rate;
    const double dx = x * pixel_size - source, dy = (y - 19.37) * pixel_size;
    const double r = std::max(std::hypot(dx, dy), 1e-9);
    const double t =
        300 + 60 / (2 * std::numbers::pi * 30 * r) * std::exp(-speed * (r + dx) / (2 * 5.5e-6));
    return std::round(signal(camera, *table, std::min(t, 6000.0), camera.emissivity));
  });
  recording.header().radiometry = camera;
  recording.header().frame_rate = rate;
  return recording;
}

TEST(Analysis, MeasuresAPassingPoolAtTheReferenceTemperature) {
  const PixelSize pixel{pixel_size, pixel_size, 0, 0};
  const LevelRequest request{.level = {},
                             .reference_temperature = 1673.15,
                             .emissivity = {},
                             .emissivity_liquid = {},
                             .transmission = {}};
  const auto a = analyse(passing_pool(), request, ScanDirection::right, pixel);
  ASSERT_TRUE(a.found);
  EXPECT_EQ(a.level.kind, LevelKind::radiometry);
  EXPECT_FALSE(a.only_incomplete);
  EXPECT_NEAR(a.length.mean, 261.80e-6, 0.01 * 261.80e-6);
  EXPECT_NEAR(a.depth.mean, 131.74e-6, 0.03 * 131.74e-6);
  EXPECT_NEAR(*a.speed, speed, 0.005 * speed);
  EXPECT_TRUE(a.length.steady());
  // The pool is 14.9 px long and moves by 2.18 px: it is whole in some 37 frames and then leaves.
  EXPECT_GE(a.length.n, 34u);
  EXPECT_LE(a.length.n, 38u);
  for (const auto& f : a.frames)
    if (f.complete) {
      EXPECT_GT(f.onset, f.end);
      EXPECT_NEAR(f.length, f.onset - f.end, 1e-12);
    }
  const auto backwards = analyse(passing_pool(), request, ScanDirection::left, pixel);
  EXPECT_NEAR(*backwards.speed, -speed, 0.005 * speed);
  EXPECT_DOUBLE_EQ(backwards.length.mean, a.length.mean);
}

TEST(Analysis, DoesNotMoveTheContourWhenSceneAndLevelAreScaledTogether) {
  // The reason for a level from the recording itself: emissivity and transmission cancel.
  const auto full = passing_pool();
  const auto& camera = *full.header().radiometry;
  const double level = signal(camera, 1673.15);
  LevelRequest request;
  request.level = level;
  const auto a = analysed(full, request);
  std::vector<Frame> frames(20);
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i] = full.frame(i);
  for (const double k : {0.5, 0.7}) {
    auto dimmed = synthetic(96, 40, frames.size(), [&](std::size_t i, double x, double y) {
      const auto at = static_cast<std::size_t>(y) * 96 + static_cast<std::size_t>(x);
      return camera.dark + k * (static_cast<double>(frames[i].values[at]) - camera.dark);
    });
    dimmed.header().radiometry = camera;
    request.level = camera.dark + k * (level - camera.dark);
    const auto b = analysed(dimmed, request);
    for (std::size_t i = 0; i < 20; ++i) ASSERT_NEAR(b.frames[i].length, a.frames[i].length, 2e-3);
  }
}

TEST(Analysis, RefusesRequestsThatDoNotFitTheRecording) {
  const auto counts = scene(5000, 9, 5);
  LevelRequest kelvin;
  kelvin.reference_temperature = 1683;
  EXPECT_THROW(analysed(counts, kelvin), InputError);
  LevelRequest level;
  level.level = 300;
  auto temperatures = counts;
  temperatures.header().quantity = SignalQuantity::temperature;
  EXPECT_THROW(analysed(temperatures, level), InputError);
  level.reference_temperature = 1683;
  EXPECT_THROW(analysed(passing_pool(), level), InputError);
}

TEST(Analysis, SaysWhenTheReferenceTemperatureIsBeyondSaturation) {
  auto recording = passing_pool();
  recording.header().saturation = signal(*recording.header().radiometry, 1500);
  const auto a = analysed(recording);
  EXPECT_FALSE(a.found);
  EXPECT_NE(a.reason.find("saturation"), std::string::npos) << a.reason;
}

TEST(Statistics, GiveTheEffectiveNumberOfAnAutoregressiveSeries) {
  // For x_i = phi x_{i-1} + noise it is n (1 - phi) / (1 + phi).
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::vector<double> v(20000);
  double x = 0;
  for (auto& value : v) value = x = 0.5 * x + normal(random);
  const auto s = summarise(v);
  EXPECT_NEAR(s.effective, 20000.0 / 3, 0.1 * 20000.0 / 3);
  EXPECT_NEAR(s.deviation, 1 / std::sqrt(0.75), 0.03);
}

TEST(Statistics, SeeATrend) {
  // Ten rising values: S = 45, var = 10 x 9 x 25 / 18 = 125, z = 44 / sqrt(125).
  std::vector<double> v(10);
  for (std::size_t i = 0; i < 10; ++i) v[i] = static_cast<double>(i);
  EXPECT_NEAR(summarise(v).trend, 44 / std::sqrt(125.0), 1e-12);
  EXPECT_FALSE(summarise(v).steady());
  EXPECT_EQ(summarise(std::vector<double>{5}).n, 1u);
}

}  // namespace
}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// Recordings on disk: a made-up run, and the round trip of an analytic pool through the extraction.
#include "imaging/camera/record.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>

#include <gtest/gtest.h>

#include "base/artifact.hpp"
#include "base/error.hpp"
#include "imaging/camera/rosenthal.hpp"
#include "imaging/meltpool/analysis.hpp"
#include "imaging/recording/formats.hpp"

namespace meltproof::imaging {
namespace {

class Film : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::path(testing::TempDir()) /
        (std::string("film_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

/// A run with the Rosenthal pool on a lattice: half a track, and a last snapshot that is cold.
void write_run(const std::filesystem::path& path, const RosenthalSettings& source, int frames,
               double interval) {
  ArtifactWriter run(path, "meltproof run");
  const double dx = 10e-6;
  run.write("spacing", dx, "m", "synthetic");
  run.write("scan_speed", source.scan_speed, "m s-1", "synthetic");
  run.write("reference_temperature", source.reference_temperature, "K", "synthetic");
  for (int k = 0; k <= frames; ++k) {
    const bool cold = k == frames;
    const double time = cold ? 0.01 : k * interval, beam = 100e-6 + source.scan_speed * time;
    std::vector<double> position, temperature, liquid;
    for (double x = -300e-6 + dx / 2; x < 500e-6; x += dx)
      for (double y = dx / 2; y < 40e-6; y += dx)
        for (double z = -120e-6 + dx / 2; z < 0; z += dx) {
          position.insert(position.end(), {x, y, z});
          const double t =
              cold ? 400 : std::min(rosenthal_temperature(source, x - beam, y, z), 3100.0);
          temperature.push_back(t);
          liquid.push_back(t > source.reference_temperature ? 1 : 0);
        }
    const std::string group = "snapshots/000" + std::to_string(k) + "/";
    const std::size_t n = temperature.size();
    run.write(group + "time", time, "s", "synthetic");
    run.write(group + "beam", std::array{beam, 0.0, 0.0}, {3}, "m", "synthetic");
    run.write(group + "position", position, {n, 3}, "m", "synthetic");
    run.write(group + "temperature", temperature, {n}, "K", "synthetic");
    run.write(group + "liquid_fraction", liquid, {n}, "1", "synthetic");
  }
  run.commit({});
}

TEST_F(Film, OfARunIsARecordingInTheCamerasForm) {
  RosenthalSettings source;
  write_run(folder_ / "run.h5", source, 4, 1 / 9762.5);
  const Recorded recorded = record_run(folder_ / "run.h5", folder_ / "recording.h5", {}, 1, {});
  EXPECT_EQ(recorded.frames, 4u);
  EXPECT_EQ(recorded.left_out, 1u);
  const Recording recording = open_recording(folder_ / "recording.h5");
  const auto& header = recording.header();
  EXPECT_EQ(header.width, 96u);
  EXPECT_EQ(header.height, 40u);
  EXPECT_EQ(header.frames, 4u);
  EXPECT_EQ(header.quantity, SignalQuantity::counts);
  EXPECT_EQ(header.synthetic, "virtual camera of run.h5");
  EXPECT_DOUBLE_EQ(header.frame_rate, 9762.5);
  EXPECT_DOUBLE_EQ(header.pixel_size, 17.6e-6);
  EXPECT_DOUBLE_EQ(header.integration_time, 20e-6);
  EXPECT_EQ(header.saturation, 16383);
  ASSERT_TRUE(header.radiometry);
  EXPECT_NEAR(header.radiometry->transmission, 0.3130, 5e-5);
  EXPECT_NEAR(recording.frame(3).time, 3 / 9762.5, 1e-12);

  const ArtifactReader file(folder_ / "recording.h5");
  EXPECT_FALSE(file.attribute("seen").empty());
  const auto length = file.read<double>("truth/visible_length").values;
  const auto column = file.read<double>("truth/beam_column").values;
  EXPECT_NEAR(length[3], rosenthal_pool(source).length, 5e-6);
  EXPECT_NEAR(column[3] - column[2], 0.375 / 9762.5 / 17.6e-6, 1e-9);
  // The pool's front runs 30 um (1.7 px) ahead of the beam; no light above the plate's surface in
  // row 12.
  const Frame frame = recording.frame(2);
  const double level = signal(*header.radiometry, source.reference_temperature, 0.2);
  int front = 0;
  for (int c = 0; c < 96; ++c)
    if (double{frame.values[static_cast<std::size_t>(13 * 96 + c)]} > level) front = c;
  EXPECT_NEAR(front + 0.5, column[2] + 1.7, 1);
  EXPECT_LT(*std::max_element(frame.values.begin(), frame.values.begin() + 9 * 96), 220);
}

TEST_F(Film, OfTheSameSeedIsTheSameAndOfAnotherIsNot) {
  write_run(folder_ / "run.h5", {}, 2, 1 / 9762.5);
  std::vector<std::vector<double>> frames;
  for (const std::uint64_t seed : {1, 1, 2}) {
    const auto place = folder_ / ("recording" + std::to_string(frames.size()) + ".h5");
    record_run(folder_ / "run.h5", place, {}, seed, {});
    frames.push_back(ArtifactReader(place).read<double>("frames").values);
  }
  EXPECT_EQ(frames[0], frames[1]);
  EXPECT_NE(frames[0], frames[2]);
}

TEST_F(Film, OfSnapshotsAtAnotherRateIsRefusedAndLeavesNothing) {
  write_run(folder_ / "run.h5", {}, 3, 1e-4);
  try {
    record_run(folder_ / "run.h5", folder_ / "recording.h5", {}, 1, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("the camera's frames 102.4 us"), std::string::npos)
        << error.what();
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "recording.h5"));
  EXPECT_THROW(record_run(folder_ / "missing.h5", folder_ / "recording.h5", {}, 1, {}), InputError);
}

/// Mean relative error of the extracted length over the frames that show the whole pool.
double round_trip(const std::filesystem::path& place, CameraSettings camera,
                  const RosenthalSettings& source, std::uint64_t seed) {
  // One emissivity, so that the level of the reference temperature is one signal; no shot noise,
  // and read noise of a hundredth of that signal.
  camera.emissivity_liquid = camera.emissivity_solid = 0.3;
  camera.full_well = 1e12;
  const double level = signal(camera_radiometry(camera), source.reference_temperature);
  camera.read_noise = (level - camera.dark) / 100;
  record_rosenthal(place, camera, source, seed, {});
  LevelRequest request;
  request.level = level;
  const Analysis analysis = analyse(open_recording(place), request, ScanDirection::right,
                                    {camera.pixel_size, camera.pixel_size, 0, 0});
  double sum = 0;
  int count = 0;
  for (const auto& frame : analysis.frames)
    if (frame.complete) sum += frame.length, ++count;
  EXPECT_GT(count, 20);
  return sum / count / rosenthal_pool(source).length - 1;
}

// From above the pool is whole, and point spread pulls at both sides of its edge.
TEST_F(Film, OfAPoolFromAboveGivesItsLengthBackWithinTwoPercent) {
  RosenthalSettings source;
  source.view = "top";
  CameraSettings camera;
  camera.surface_row = 19.6;
  for (const std::uint64_t seed : {1, 2}) {
    const double error = round_trip(folder_ / "pool.h5", camera, source, seed);
    RecordProperty("relative_error", std::to_string(error));
    EXPECT_NEAR(error, 0, 0.02);
  }
}

// From the side the pool ends at the plate's surface, above which there is nothing: what point
// spread takes from the uppermost row is not given back. Without point spread the length returns.
TEST_F(Film, OfAPoolFromTheSideIsShortenedByThePointSpread) {
  RosenthalSettings source;
  CameraSettings camera;
  camera.integration_time = 1e-6;
  camera.surface_row = 11.5;  // the surface on a pixel's border
  camera.point_spread = 0;
  const double sharp = round_trip(folder_ / "pool.h5", camera, source, 1);
  camera.point_spread = 0.8;
  const double blurred = round_trip(folder_ / "pool.h5", camera, source, 1);
  std::cout << "side view, relative error of the length: " << sharp << " without, " << blurred
            << " with point spread\n";
  EXPECT_NEAR(sharp, 0, 0.05);
  EXPECT_LT(blurred, sharp);
}

}  // namespace
}  // namespace meltproof::imaging

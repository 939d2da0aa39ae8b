// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/hdf5.hpp"

#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/artifact.hpp"
#include "base/error.hpp"
#include "imaging/recording/formats.hpp"

namespace meltproof::imaging {
namespace {

namespace fs = std::filesystem;

TEST(Hdf5, RoundTripsARecordingWithItsRadiometry) {
  const fs::path path =
      fs::temp_directory_path() / fmt::format("meltproof-{}-recording.h5", ::getpid());
  {
    ArtifactWriter writer(path, "meltproof recording");
    const std::vector<std::uint16_t> frames = {0,   100, 200, 300, 400,  500,
                                               600, 700, 800, 900, 1000, 16383};
    writer.write("frames", frames, {2, 2, 3}, "count", "synthetic frames");
    writer.write("time", std::vector<double>{0.5, 0.5 + 1 / 9762.5}, {2}, "s",
                 "time of each frame");
    writer.write("integration_time", 20e-6, "s", "integration time");
    writer.write("frame_rate", 9762.5, "Hz", "frame rate");
    writer.write("pixel_size", 17.6e-6, "m", "pixel size on the object");
    writer.write("saturation_count", 16383.0, "count", "largest count");
    const std::pair<const char*, double> radiometry[] = {
        {"band_lower", 3e-6},          {"band_upper", 5e-6}, {"transmission", 0.313},
        {"emissivity", 0.2},           {"gain", 12.0},       {"dark", 500.0},
        {"ambient_temperature", 300.0}};
    for (const auto& [name, value] : radiometry)
      writer.write(std::string("radiometry/") + name, value, "1", "test");
    writer.attribute("quantity", "counts");
    writer.attribute("synthetic", "written by a test");
    writer.commit(Provenance{});
  }
  const auto recording = open_recording(path);
  const auto& h = recording.header();
  EXPECT_EQ(h.frames, 2u);
  EXPECT_EQ(h.height, 2u);
  EXPECT_EQ(h.width, 3u);
  EXPECT_EQ(h.frame_rate, 9762.5);
  EXPECT_EQ(h.pixel_size, 17.6e-6);
  EXPECT_EQ(h.synthetic, "written by a test");
  ASSERT_TRUE(h.radiometry);
  EXPECT_EQ(h.radiometry->transmission, 0.313);
  EXPECT_EQ(h.radiometry->integration_time, 20e-6);
  const auto f = recording.frame(1);
  EXPECT_EQ(f.values, (std::vector<float>{600, 700, 800, 900, 1000, 16383}));
  EXPECT_EQ(f.status.back(), PixelStatus::saturated);
  EXPECT_EQ(recording.frame(0).status.front(), PixelStatus::under_range);
  EXPECT_NEAR(f.time, 1 / 9762.5, 1e-12);
  fs::remove(path);
}

TEST(Hdf5, RefusesAnotherKindOfArtifact) {
  const fs::path path = fs::temp_directory_path() / fmt::format("meltproof-{}-bed.h5", ::getpid());
  {
    ArtifactWriter writer(path, "meltproof powder bed");
    writer.write("packing_density", 0.5, "1", "test");
    writer.commit(Provenance{});
  }
  EXPECT_THROW(open_recording(path), InputError);
  fs::remove(path);
}

}  // namespace
}  // namespace meltproof::imaging

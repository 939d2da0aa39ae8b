// SPDX-License-Identifier: GPL-3.0-or-later
// meltproof-calibrate and meltproof-camera as a user runs them.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "base/atomic_file.hpp"

namespace {

namespace fs = std::filesystem;

class Programs : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / fmt::format("meltproof-calibrate-{}", ::getpid());
    fs::create_directories(folder_ / "out");
  }
  void TearDown() override { fs::remove_all(folder_); }
  int run(const std::string& command) {
    const std::string log = (folder_ / "log").string();
    const int status = std::system(fmt::format("{} > {} 2>&1", command, log).c_str());
    text_ = meltproof::read_file(log);
    return WEXITSTATUS(status);
  }
  int calibrate(const std::string& arguments) {
    return run(fmt::format("{} {} --output {}", CALIBRATE, arguments, result().string()));
  }
  int camera(const std::string& arguments) {
    return run(
        fmt::format("{} {} --output {}", CAMERA, arguments, (folder_ / "out" / "x.h5").string()));
  }
  fs::path result() const { return folder_ / "out" / "calibration.json"; }
  fs::path file(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  void expect_nothing_written(const std::string& said) {
    EXPECT_NE(text_.find(said), std::string::npos) << text_;
    EXPECT_TRUE(fs::is_empty(folder_ / "out")) << text_;
  }
  fs::path folder_;
  std::string text_;
};

const std::string scale = "data/scales/synthetic_across_x.h5";

TEST_F(Programs, CalibrateWritesResultAndPicture) {
  ASSERT_EQ(calibrate(scale + " --graduation '100 um' --graduation-is period"), 0) << text_;
  const auto json = nlohmann::json::parse(meltproof::read_file(result()));
  EXPECT_NEAR(json["pixel_size_x_um"].get<double>(), 17.6, 0.01);
  EXPECT_GT(json["u_pixel_size_x_um"].get<double>(), 0);
  EXPECT_NE(json["assumption"].get<std::string>().find("square pixels"), std::string::npos);
  EXPECT_EQ(json["images"][0]["sha256"].get<std::string>().size(), 64u);
  EXPECT_EQ(json["provenance"]["program"], "meltproof-calibrate");
  EXPECT_GT(fs::file_size(fs::path(result()).replace_extension(".png")), 1000u);
}

TEST_F(Programs, CalibrateRefusesInASentence) {
  EXPECT_EQ(calibrate(scale + " --graduation-is period"), 2);
  expect_nothing_written("--graduation is missing");
  EXPECT_EQ(calibrate(scale + " --graduation '100 um'"), 2);
  expect_nothing_written("factor of 2");
  EXPECT_EQ(calibrate(scale + " --graduation '100 um' --graduation-is pitch"), 2);
  expect_nothing_written("\"pitch\"");
  EXPECT_EQ(calibrate(scale + " --graduation '100 K' --graduation-is period"), 2);
  expect_nothing_written("--graduation");
  EXPECT_EQ(calibrate("missing.png --graduation '100 um' --graduation-is period"), 2);
  expect_nothing_written("missing.png");
  EXPECT_EQ(calibrate(file("text.png", "no picture").string() +
                      " --graduation '100 um' --graduation-is period"),
            2);
  expect_nothing_written("text.png");
  EXPECT_EQ(calibrate(fmt::format("{0} {0} --graduation '100 um' --graduation-is period", scale)),
            2);
  expect_nothing_written("turn the scale by 90 degrees");
}

TEST_F(Programs, CalibrateSaysThatAPoolIsNoScale) {
  const std::string pool = (folder_ / "pool.h5").string();
  ASSERT_EQ(run(fmt::format("{} --rosenthal --output {}", CAMERA, pool)), 0) << text_;
  EXPECT_EQ(calibrate(pool + " --graduation '100 um' --graduation-is period"), 3);
  expect_nothing_written("pool.h5");
}

TEST_F(Programs, CameraRefusesInASentence) {
  EXPECT_EQ(camera(""), 2);
  expect_nothing_written("Name one thing to film");
  EXPECT_EQ(camera("missing.h5"), 2);
  expect_nothing_written("missing.h5");
  EXPECT_EQ(camera(scale), 2);
  expect_nothing_written("meltproof run");
  EXPECT_EQ(camera("--rosenthal --settings " + file("a.toml", "[sensor]\nbitz = 12\n").string()),
            2);
  expect_nothing_written("bitz");
  EXPECT_EQ(camera("--rosenthal --settings " +
                   file("b.toml", "[optics]\npixel_size = \"17.6 K\"\n").string()),
            2);
  expect_nothing_written("pixel_size");
  EXPECT_EQ(camera("--rosenthal --settings " +
                   file("c.toml", "[optics]\nband_lower = \"6 um\"\n").string()),
            2);
  expect_nothing_written("band");
}

}  // namespace

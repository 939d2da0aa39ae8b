// SPDX-License-Identifier: GPL-3.0-or-later
// The whole program, run as a user runs it.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "base/atomic_file.hpp"

namespace {

namespace fs = std::filesystem;
using meltproof::read_file;

const fs::path samples = "../shared/samples";

class Thermography : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / fmt::format("meltproof-program-{}", ::getpid());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Runs the program with these arguments and the output folder; what it says is in text_.
  int run(const std::string& arguments) {
    const std::string log = (folder_ / "log").string();
    const int status = std::system(
        fmt::format("{} {} --output {} > {} 2>&1", PROGRAM, arguments, output().string(), log)
            .c_str());
    text_ = read_file(log);
    return WEXITSTATUS(status);
  }
  fs::path output() const { return folder_ / "out"; }
  fs::path file(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  nlohmann::json summary() const {
    return nlohmann::json::parse(read_file(output() / "summary.json"));
  }
  bool everything_is_written() const {
    for (const char* name : {"summary.json", "frames.csv", "annotated.png", "contact_sheet.png"})
      if (!fs::exists(output() / name)) return false;
    return std::distance(fs::directory_iterator(output()), {}) == 4;  // and no temporary file
  }
  /// Status 2, one sentence that names the file, and no output.
  void expect_refusal(const std::string& arguments, const std::string& said) {
    fs::remove_all(output());
    EXPECT_EQ(run(arguments), 2) << text_;
    EXPECT_NE(text_.find(said), std::string::npos) << text_;
    EXPECT_FALSE(fs::exists(output())) << text_;
  }

  fs::path folder_;
  std::string text_;
};

#define NEED_SAMPLES \
  if (!fs::exists(samples)) GTEST_SKIP() << "the vendors' samples are not here"

TEST_F(Thermography, DescribesThePtwSampleAndSaysThatItHasNoPool) {
  NEED_SAMPLES;
  EXPECT_EQ(run((samples / "cedip_pyradi_PyradiSampleMWIR.ptw").string()), 3) << text_;
  EXPECT_TRUE(everything_is_written());
  const auto s = summary();
  EXPECT_EQ(s["frames"], 100);
  EXPECT_EQ(s["width"], 69);
  EXPECT_EQ(s["height"], 64);
  EXPECT_EQ(s["frame_rate"], 100);
  EXPECT_EQ(s["quantity"], "counts");
  EXPECT_EQ(s["melt_pool_found"], false);
  EXPECT_EQ(s["integration_time_s"], 0.0005);
  EXPECT_NE(text_.find("No melt pool"), std::string::npos);
  const std::string table = read_file(output() / "frames.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 101);
  EXPECT_NE(table.find("\n0,0,6116,6439,6269.10009,"), std::string::npos) << table.substr(0, 400);
  std::istringstream rows(table);
  for (std::string row; std::getline(rows, row);)
    EXPECT_EQ(std::count(row.begin(), row.end(), ','), 19) << row;
}

TEST_F(Thermography, DescribesTheSeqAndTiffSamples) {
  NEED_SAMPLES;
  EXPECT_EQ(run((samples / "flir_thermimage_SampleSEQ.seq").string()), 3) << text_;
  EXPECT_EQ(summary()["frames"], 2);
  EXPECT_EQ(summary()["quantity"], "temperature");
  EXPECT_NE(read_file(output() / "frames.csv").find(",17220,20817,17870.47767,"),
            std::string::npos);
  EXPECT_EQ(run((samples / "flir_flirpy_example_radiometric.tiff").string()), 3) << text_;
  EXPECT_EQ(summary()["width"], 640);
  EXPECT_TRUE(summary()["frame_rate"].is_null());
  EXPECT_EQ(run((samples / "flir_flirpy_example_radiometric.tiff").string() +
                " --kelvin-per-count '0.04 K'"),
            3)
      << text_;
  EXPECT_EQ(summary()["quantity"], "temperature");
}

TEST_F(Thermography, FindsTheMeltPoolOfNistAndScalesItByACalibration) {
  NEED_SAMPLES;
  const std::string bmp = (samples / "meltpool_sample_img.bmp").string();
  EXPECT_EQ(run(bmp), 0) << text_;
  EXPECT_TRUE(everything_is_written());
  EXPECT_EQ(summary()["melt_pool_found"], true);
  EXPECT_EQ(run(bmp + " --level 80"), 0) << text_;
  const double pixels = summary()["length_px"]["mean"];
  const auto calibration = file(
      "calibration.json",
      R"({"pixel_size_x_um": 8.0, "pixel_size_y_um": 9.0, "u_pixel_size_x_um": 0.1, "u_pixel_size_y_um": 0.1})");
  EXPECT_EQ(run(bmp + " --level 80 --calibration " + calibration.string()), 0) << text_;
  EXPECT_NEAR(summary()["length_um"]["mean"].get<double>(), 8 * pixels, 1e-9);
  EXPECT_NEAR(summary()["length_um"]["u_parts"]["pixel size"].get<double>(), 0.1 * pixels, 1e-9);
  // The settings file holds the same keys; what is typed wins.
  const auto settings = file(
      "settings.toml", "level = 40\ncalibration = \"calibration.json\"\nscan_direction = \"+y\"\n");
  EXPECT_EQ(run(bmp + " --level 80 --settings " + settings.string()), 0) << text_;
  EXPECT_NEAR(summary()["depth_um"]["mean"].get<double>(), 8 * pixels, 1e-9);
  EXPECT_EQ(summary()["level"]["value"], 80);
}

TEST_F(Thermography, TwoRunsGiveTheSameTablesAndPictures) {
  NEED_SAMPLES;
  const std::string bmp = (samples / "meltpool_sample_img.bmp").string();
  std::string first[3];
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(run(bmp), 0);
    int k = 0;
    for (const char* name : {"frames.csv", "annotated.png", "contact_sheet.png"}) {
      const std::string bytes = read_file(output() / name);
      if (i == 0) first[k] = bytes;
      EXPECT_EQ(bytes, first[k++]) << name;
    }
  }
}

TEST_F(Thermography, KeepsTheWholeFramesOfATruncatedRecording) {
  NEED_SAMPLES;
  const std::string whole = read_file(samples / "cedip_pyradi_PyradiSampleMWIR.ptw");
  const auto cut = file("cut.ptw", whole.substr(0, whole.size() / 2));
  EXPECT_EQ(run(cut.string()), 4) << text_;
  EXPECT_TRUE(everything_is_written());
  EXPECT_EQ(summary()["frames"].get<int>() + summary()["frames_lost"].get<int>(), 100);
  EXPECT_NE(text_.find("ends early"), std::string::npos) << text_;
  expect_refusal(file("start.ptw", whole.substr(0, 4000)).string() + " -q",
                 "before its first frame is whole");
}

TEST_F(Thermography, RecoversTheLengthOfAnAnalyticPoolFilmedByTheVirtualCamera) {
  // Round trip on a synthetic pool of exactly known size: 261.80 um long, 65.87 um deep, 0.375 m/s.
  const fs::path pool = folder_ / "pool.h5";
  ASSERT_EQ(
      std::system(
          fmt::format("{} --rosenthal --seed 1 --output {} -q", CAMERA, pool.string()).c_str()),
      0);
  const std::string at =
      pool.string() + " --reference-temperature '1673.15 K' --scan-speed '0.375 m/s'";
  EXPECT_EQ(run(at), 0) << text_;
  const auto s = summary();
  EXPECT_EQ(s["width"], 96);
  EXPECT_EQ(s["height"], 40);
  EXPECT_EQ(s["frame_rate"], 9762.5);
  EXPECT_FALSE(s["synthetic"].is_null());
  EXPECT_NE(text_.find("SYNTHETIC"), std::string::npos);
  // The plate's surface cuts through a row of pixels, and a row further down the pool is 3 %
  // shorter.
  EXPECT_NEAR(s["length_um"]["mean"].get<double>(), 261.80, 0.035 * 261.80);
  EXPECT_LT(s["length_um"]["sd"].get<double>(), 2);
  EXPECT_GE(s["length_um"]["n"].get<int>(), 30);
  EXPECT_NEAR(s["speed_m_s"].get<double>(), 0.375, 0.001 * 0.375);
  EXPECT_TRUE(s["steady"]["steady"].get<bool>());
  // One emissivity for both phases misses the front by far: the reason for looking for its step.
  EXPECT_EQ(run(at + " --emissivity-liquid 0.3"), 0) << text_;
  EXPECT_LT(summary()["length_um"]["mean"].get<double>(), 0.8 * 261.80);
  EXPECT_EQ(run(at + " --emissivity 0.2"), 0) << text_;
  EXPECT_GT(summary()["length_um"]["mean"].get<double>(), 1.08 * 261.80);
}

TEST_F(Thermography, IsToldHowToReadWhatAFileDoesNotSay) {
  // Synthetic: two frames of 8 rows one behind the other, a warm square in each.
  std::string text;
  for (int row = 0; row < 16; ++row)
    for (int column = 0; column < 10; ++column) {
      const bool warm = row % 8 >= 2 && row % 8 < 6 && column >= 3 && column < 7;
      text += std::to_string(warm ? 900 : 100) + (column < 9 ? ";" : "\n");
    }
  const std::string csv = file("frames.csv", text).string();
  EXPECT_EQ(run(csv + " --level 500 --settings " +
                file("r.toml", "[reading]\nframe_rows = 8\nunit = 'count'\n").string()),
            0)
      << text_;
  EXPECT_EQ(summary()["frames"], 2);
  EXPECT_EQ(summary()["height"], 8);
  expect_refusal(csv + " --settings " + file("w.toml", "[reading]\nunit = 'furlong'\n").string(),
                 "reading.unit");
}

TEST_F(Thermography, RefusesInOneSentenceAndLeavesNothingBehind) {
  expect_refusal(file("notes.ptw", "Monday: cleaned the lens.\n").string(), "text");
  expect_refusal((folder_ / "missing.ptw").string(), "no such file");
  // A folder is a recording of the files in it; in this one there is only the note.
  expect_refusal(folder_.string(), "text");
  const auto picture = samples / "meltpool_sample_img.bmp";
  if (!fs::exists(picture)) return;
  expect_refusal(picture.string() + " --reference-temperature '1683 m'", "reference_temperature");
  expect_refusal(picture.string() + " --reference-temperature '1683 K'",
                 "without the camera's band");
  expect_refusal(picture.string() + " --settings " + file("s.toml", "levle = 3\n").string(),
                 "levle");
  expect_refusal(picture.string() + " --calibration " + file("c.json", "{}").string(),
                 "pixel_size_x_um");
  expect_refusal(picture.string() + " --scan-direction sideways", "scan_direction");
}

}  // namespace

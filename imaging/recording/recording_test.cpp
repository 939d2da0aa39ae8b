// SPDX-License-Identifier: GPL-3.0-or-later
// The readers against files that nobody here wrote; every number is published in the samples'
// README.
#include <algorithm>
#include <filesystem>
#include <numeric>
#include <string>

#include <gtest/gtest.h>

#include "base/atomic_file.hpp"
#include "imaging/recording/formats.hpp"
#include "imaging/recording/synthetic_files.hpp"
#include "imaging/recording/test_folder.hpp"

namespace meltproof::imaging {
namespace {

namespace fs = std::filesystem;

const fs::path samples = "../shared/samples";

#define NEED_SAMPLE(name) \
  if (!fs::exists(samples / (name))) GTEST_SKIP() << "the sample " << (name) << " is not here"

constexpr const char* ptw = "cedip_pyradi_PyradiSampleMWIR.ptw";
constexpr const char* seq = "flir_thermimage_SampleSEQ.seq";
constexpr const char* tiff = "flir_flirpy_example_radiometric.tiff";
constexpr const char* bmp = "meltpool_sample_img.bmp";

double mean(const std::vector<float>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
}
float lowest(const std::vector<float>& v) { return *std::min_element(v.begin(), v.end()); }
float highest(const std::vector<float>& v) { return *std::max_element(v.begin(), v.end()); }

std::string refusal(const fs::path& path) {
  return refusal_of([&] { open_recording(path); });
}

TEST(Ptw, ReadsThePyradiSample) {
  NEED_SAMPLE(ptw);
  const auto recording = open_recording(samples / ptw);
  const auto& h = recording.header();
  EXPECT_EQ(h.format, "Cedip PTW");
  EXPECT_EQ(h.width, 69u);
  EXPECT_EQ(h.height, 64u);
  EXPECT_EQ(h.frames, 100u);
  EXPECT_EQ(h.frames_lost, 0u);
  EXPECT_DOUBLE_EQ(h.frame_rate, 100);
  EXPECT_DOUBLE_EQ(h.integration_time, 500e-6);
  EXPECT_EQ(h.saturation, 16383);
  EXPECT_EQ(h.quantity, SignalQuantity::counts);
  EXPECT_EQ(h.sha256.size(), 64u);
  const auto first = recording.frame(0);
  EXPECT_EQ(first.values[0], 6142);
  EXPECT_EQ(first.values[32 * 69 + 34], 6265);
  EXPECT_EQ(first.values[10 * 69 + 20], 6196);
  EXPECT_NEAR(mean(first.values), 6269.10009, 5e-6);
  const auto last = recording.frame(99);
  EXPECT_EQ(last.values.back(), 6345);
  EXPECT_DOUBLE_EQ(last.time, 0.99);
  float low = 1e9F, high = 0;
  Frame frame;
  for (std::size_t i = 0; i < h.frames; ++i) {
    recording.read(i, frame);
    low = std::min(low, lowest(frame.values));
    high = std::max(high, highest(frame.values));
  }
  EXPECT_EQ(low, 6106);
  EXPECT_EQ(high, 6462);
}

TEST(Ptw, SaysThatTheFramesClockContradictsTheHeader) {
  // The stamps of this sample go from 27.78 s to 30.75 s over 99 frames: 30 ms, not 10 ms.
  NEED_SAMPLE(ptw);
  const auto notes = open_recording(samples / ptw).header().notes;
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("0.0300 s a frame"), std::string::npos) << notes[0];
}

TEST(Ptw, KeepsTheWholeFramesOfATruncatedFileAndCountsTheLost) {
  NEED_SAMPLE(ptw);
  const TestFolder folder;
  const std::string whole = read_file(samples / ptw);
  constexpr std::size_t stride = 1016 + 2 * 69 * 64;
  const auto cut = open_recording(folder.file("cut.ptw", whole.substr(0, 3476 + 41 * stride + 77)));
  EXPECT_EQ(cut.header().frames, 41u);
  EXPECT_EQ(cut.header().frames_lost, 59u);
  EXPECT_EQ(cut.frame(40).values, open_recording(samples / ptw).frame(40).values);
  EXPECT_THROW(cut.frame(41), InputError);
  const auto short_by_a_byte =
      open_recording(folder.file("byte.ptw", whole.substr(0, whole.size() - 1)));
  EXPECT_EQ(short_by_a_byte.header().frames, 99u);
  EXPECT_EQ(short_by_a_byte.header().frames_lost, 1u);
  EXPECT_THROW(open_recording(folder.file("none.ptw", whole.substr(0, 3476 + stride - 1))),
               InputError);
  EXPECT_THROW(open_recording(folder.file("header.ptw", whole.substr(0, 300))), InputError);
}

TEST(Flir, ReadsTheThermimageSampleWithTemperatures) {
  NEED_SAMPLE(seq);
  const auto recording = open_recording(samples / seq);
  const auto& h = recording.header();
  EXPECT_EQ(h.width, 640u);
  EXPECT_EQ(h.height, 480u);
  EXPECT_EQ(h.frames, 2u);  // the magic also occurs at 449999, inside pixels
  EXPECT_EQ(h.frames_lost, 0u);
  EXPECT_EQ(h.quantity, SignalQuantity::temperature);
  EXPECT_DOUBLE_EQ(h.frame_rate, 30);
  EXPECT_EQ(h.calibration.at("planck_r1"), 21106.76953125);
  EXPECT_EQ(h.calibration.at("planck_b_K"), 1501);
  EXPECT_EQ(h.calibration.at("planck_o"), -7340);
  EXPECT_EQ(h.calibration.at("planck_r2"), 0.012545257806777954);
  EXPECT_EQ(h.calibration.at("relative_humidity"), 0.5);
  const auto f = recording.frame(0);
  EXPECT_EQ(f.counts[0], 17870);
  EXPECT_EQ(f.counts[240 * 640 + 320], 17853);
  EXPECT_EQ(f.counts[10 * 640 + 20], 17834);
  EXPECT_EQ(lowest(f.counts), 17220);
  EXPECT_EQ(highest(f.counts), 20817);
  EXPECT_NEAR(mean(f.counts), 17870.47767, 5e-6);
  // A float of 295 K has steps of 3e-5 K.
  EXPECT_NEAR(f.values[0] - 273.15, 22.46279, 2e-5);
  EXPECT_NEAR(f.values[240 * 640 + 320] - 273.15, 22.36381, 2e-5);
  EXPECT_NEAR(lowest(f.values) - 273.15, 18.60133, 2e-5);
  EXPECT_NEAR(highest(f.values) - 273.15, 38.27134, 2e-5);
  EXPECT_NEAR(recording.frame(1).time, 3.967, 1e-6);  // 1339617132.666 - 1339617128.699
}

TEST(Flir, KeepsTheWholeFramesOfATruncatedFile) {
  NEED_SAMPLE(seq);
  const TestFolder folder;
  const std::string whole = read_file(samples / seq);
  for (const std::size_t size :
       {whole.size() - 1, std::size_t{617180 + 100}, std::size_t{617180 + 2}}) {
    const auto cut = open_recording(folder.file("cut.seq", whole.substr(0, size)));
    EXPECT_EQ(cut.header().frames, 1u) << size;
    EXPECT_EQ(cut.header().frames_lost, 1u) << size;
  }
  EXPECT_THROW(open_recording(folder.file("none.seq", whole.substr(0, 617179))), InputError);
}

TEST(Tiff, ReadsTheFlirpySampleAndItsLinearTemperature) {
  NEED_SAMPLE(tiff);
  const auto recording = open_recording(samples / tiff);
  const auto& h = recording.header();
  EXPECT_EQ(h.width, 640u);
  EXPECT_EQ(h.height, 512u);
  EXPECT_EQ(h.frames, 1u);
  const auto f = recording.frame(0);
  EXPECT_EQ(f.values[0], 6791);
  EXPECT_EQ(f.values[256 * 640 + 320], 7021);
  EXPECT_EQ(lowest(f.values), 6743);
  EXPECT_EQ(highest(f.values), 7077);
  EXPECT_NEAR(mean(f.values), 6983.25207, 5e-6);
  const auto warm = with_linear_temperature(recording, 0.04, 0).frame(0);
  EXPECT_NEAR(mean(warm.values) - 273.15, 6.180, 5e-4);
  EXPECT_EQ(warm.counts, f.values);
}

TEST(Picture, ReadsTheMeltPoolFrameOfNistTopDown) {
  NEED_SAMPLE(bmp);
  const auto recording = open_recording(samples / bmp);
  EXPECT_EQ(recording.header().width, 120u);
  EXPECT_EQ(recording.header().height, 128u);
  EXPECT_EQ(recording.header().frames, 1u);
  EXPECT_EQ(recording.header().frame_rate, 0);
  const auto f = recording.frame(0);
  EXPECT_EQ(highest(f.values), 255);
  EXPECT_NEAR(mean(f.values), 7.12962, 5e-6);
  const auto above = [&](float level) {
    return std::count_if(f.values.begin(), f.values.end(), [&](float v) { return v >= level; });
  };
  EXPECT_EQ(above(40), 214);
  EXPECT_EQ(above(80), 139);
  EXPECT_EQ(above(128), 100);
  EXPECT_EQ(above(200), 66);
  double x = 0, y = 0;
  for (std::size_t i = 0; i < f.values.size(); ++i)
    if (f.values[i] >= 128) {
      x += static_cast<double>(i % 120) / 100;
      y += static_cast<double>(i / 120) / 100;
    }
  EXPECT_NEAR(x, 51.91, 1e-9);
  EXPECT_NEAR(y, 66.97, 1e-9);
  EXPECT_EQ(f.status[63 * 120 + 50], PixelStatus::saturated);
}

TEST(Picture, RefusesATruncatedPictureInsteadOfReadingZeros) {
  NEED_SAMPLE(bmp);
  const TestFolder folder;
  const std::string whole = read_file(samples / bmp);
  EXPECT_NE(refusal(folder.file("cut.bmp", whole.substr(0, 9000))).find("ends before its last row"),
            std::string::npos);
}

TEST(Picture, RefusesWhatOpenCvWouldFillWithZeros) {
  const TestFolder folder;
  const auto picture = synthetic::scene(20, 10, 0);
  const std::string deflated = synthetic::png(picture), rows = synthetic::bmp(picture);
  ASSERT_EQ(refusal(folder.file("a.png", deflated)), "");
  ASSERT_EQ(refusal(folder.file("a.bmp", rows)), "");
  for (std::size_t at = 8; at < deflated.size(); ++at) {  // every byte has a checksum
    std::string bad = deflated;
    bad[at] = static_cast<char>(bad[at] ^ 1);
    EXPECT_NE(refusal(folder.file("b.png", bad)), "") << at;
  }
  std::string packed = rows, endless = rows;
  packed[30] = 1;
  EXPECT_TRUE(says(refusal(folder.file("c.bmp", packed)), "run-length"));
  endless[24] = 1;  // 65536 rows more
  EXPECT_TRUE(says(refusal(folder.file("d.bmp", endless)), "ends before its last row"));
}

TEST(OpenRecording, SaysInASentenceWhatIsWrong) {
  const TestFolder folder;
  const std::string text = refusal(folder.file("notes.ptw", "The quick brown fox\nand more\n"));
  EXPECT_NE(text.find("its content is text (it begins with \"The quick brown fox\")"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("CED"), std::string::npos) << text;
  EXPECT_NE(refusal(folder.file("cedar.ptw", "CEDAR is a tree, and this is long enough a text."))
                .find("text"),
            std::string::npos);
  EXPECT_NE(refusal(folder.file("a.ats", std::string(100, '\1'))).find("closed"),
            std::string::npos);
  EXPECT_NE(refusal(folder.file("empty.seq", "")).find("empty"), std::string::npos);
  EXPECT_NE(refusal(folder.file("a.xyz", std::string(100, '\1'))).find(".seq"), std::string::npos);
  EXPECT_NE(refusal("no/such/file.ptw").find("no such file"), std::string::npos);
}

TEST(OpenRecording, GoesByContentNotByName) {
  NEED_SAMPLE(bmp);
  const TestFolder folder;
  EXPECT_EQ(open_recording(folder.file("wrong.ptw", read_file(samples / bmp))).header().format,
            "picture");
}

}  // namespace
}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// FLIR's compressed frames and its JPEG, from synthetic files: no real one is at hand.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "imaging/recording/flir.hpp"
#include "imaging/recording/flir_jpeg.hpp"
#include "imaging/recording/formats.hpp"
#include "imaging/recording/synthetic_files.hpp"
#include "imaging/recording/test_folder.hpp"

namespace meltproof::imaging {
namespace {

using synthetic::Pixels;

std::vector<float> as_float(const synthetic::Picture& p) {
  return {p.counts.begin(), p.counts.end()};
}

TEST(FlirCoding, ReadsTheSameCountsHoweverTheyAreStored) {
  const TestFolder folder;
  for (const auto pixels : {Pixels::raw, Pixels::png, Pixels::png_exchanged, Pixels::jpeg_ls})
    for (const bool big_header : {false, true})
      for (const bool big_records : {false, true}) {
        std::string file;
        for (std::uint32_t i = 0; i < 3; ++i)
          file += synthetic::flir_block(synthetic::scene(24, 17, i), {.pixels = pixels,
                                                                      .big_header = big_header,
                                                                      .big_records = big_records,
                                                                      .milliseconds = 699 + 100 * i,
                                                                      .frame_rate = 10});
        const auto recording = open_recording(folder.file("a.csq", file));
        ASSERT_EQ(recording.header().frames, 3u);
        EXPECT_EQ(recording.header().frames_lost, 0u);
        EXPECT_EQ(recording.header().quantity, SignalQuantity::temperature);
        for (const std::size_t i : {2u, 0u, 1u}) {
          const auto f = recording.frame(i);
          EXPECT_EQ(f.counts, as_float(synthetic::scene(24, 17, i)))
              << static_cast<int>(pixels) << big_header << big_records;
          EXPECT_NEAR(f.time, 0.1 * static_cast<double>(i), 1e-9);
        }
        // By FLIR's formula 17870 counts are 22.46279 C with these constants (the samples' README).
        const auto f = recording.frame(0);
        for (std::size_t k = 0; k < f.counts.size(); ++k)
          ASSERT_EQ(f.counts[k] > 17870, f.values[k] > 273.15F + 22.46279F) << f.counts[k];
      }
}

TEST(FlirCoding, SaysHowThePngWasRead) {
  const TestFolder folder;
  const auto notes = [&](Pixels pixels) {
    const auto path = folder.file(
        "a.fff", synthetic::flir_block(synthetic::scene(24, 17, 0), {.pixels = pixels}));
    return open_flir(path).header().notes;
  };
  ASSERT_EQ(notes(Pixels::png).size(), 1u);
  EXPECT_TRUE(says(notes(Pixels::png)[0], "regular bytes"));
  EXPECT_TRUE(says(notes(Pixels::png_exchanged)[0], "exchanged bytes"));
  EXPECT_TRUE(notes(Pixels::jpeg_ls).empty());
}

TEST(FlirCoding, RefusesDamagedFramesInsteadOfReadingZeros) {
  const TestFolder folder;
  const auto picture = synthetic::scene(24, 17, 0);
  const std::size_t pixels_at = 64 + 3 * 32 + 0x466 + 32;
  for (const auto pixels : {Pixels::png_exchanged, Pixels::jpeg_ls}) {
    const std::string good = synthetic::flir_block(picture, {.pixels = pixels});
    std::size_t refused = 0, same = 0, other = 0;
    for (std::size_t at = pixels_at; at < good.size(); ++at) {
      std::string bad = good;
      bad[at] = static_cast<char>(bad[at] ^ 0x10);
      const auto path = folder.file("bad.csq", bad);
      try {
        const auto f = open_flir(path).frame(0);
        ++(f.counts == as_float(picture) ? same : other);
      } catch (const InputError&) {
        ++refused;
      }
    }
    EXPECT_GT(refused, 0u);
    // PNG has checksums. JPEG-LS has none, so a wrong bit can pass for other counts; but never for
    // a frame that ends in zeros, which the next test asks.
    if (pixels == Pixels::png_exchanged) {
      EXPECT_EQ(other, 0u);
    }
  }
}

TEST(FlirCoding, RefusesAJpegLsThatEndsEarly) {
  const TestFolder folder;
  const auto picture = synthetic::scene(24, 17, 0);
  std::string block = synthetic::flir_block(picture, {.pixels = Pixels::jpeg_ls});
  std::fill(block.end() - 120, block.end(), '\0');
  const auto recording = open_flir(folder.file("bad.csq", block));
  EXPECT_TRUE(says(refusal_of([&] { recording.frame(0); }), "frame 0 holds a JPEG-LS"));
}

TEST(FlirCoding, RefusesASizeThatTheRecordCannotHold) {
  const TestFolder folder;
  std::string block =
      synthetic::flir_block(synthetic::scene(24, 17, 0), {.pixels = Pixels::jpeg_ls});
  const std::size_t raw = 64 + 3 * 32 + 0x466;
  block[raw + 3] = '\x40';  // width 24 + 0x4000
  block[raw + 5] = '\x40';
  const auto path = folder.file("big.csq", block);
  EXPECT_TRUE(says(refusal_of([&] { open_flir(path); }), "16408 x 16401 pixels"));
}

TEST(FlirCoding, ReadsCountsWhereTheCameraStoredNoCalibration) {
  const TestFolder folder;
  const auto picture = synthetic::scene(8, 6, 0);
  const auto recording =
      open_flir(folder.file("a.seq", synthetic::flir_block(picture, {.camera = false})));
  EXPECT_EQ(recording.header().quantity, SignalQuantity::counts);
  EXPECT_EQ(recording.frame(0).values, as_float(picture));
  ASSERT_EQ(recording.header().notes.size(), 1u);
  EXPECT_TRUE(says(recording.header().notes[0], "no calibration"));
}

TEST(FlirJpeg, PutsTheBlockTogetherFromItsParts) {
  const TestFolder folder;
  const auto picture = synthetic::scene(24, 17, 0);
  for (const auto pixels : {Pixels::raw, Pixels::png_exchanged})
    for (const std::size_t part : {100u, 60000u}) {
      const auto block = synthetic::flir_block(picture, {.pixels = pixels, .big_header = true});
      const auto recording =
          open_recording(folder.file("IR_0001.jpg", synthetic::flir_jpeg(block, part)));
      EXPECT_EQ(recording.header().format, "FLIR JPEG");
      ASSERT_EQ(recording.header().frames, 1u);
      EXPECT_EQ(recording.frame(0).counts, as_float(picture));
      EXPECT_EQ(recording.header().quantity, SignalQuantity::temperature);
    }
}

TEST(FlirJpeg, SaysWhatIsMissing) {
  const TestFolder folder;
  const auto block = synthetic::flir_block(synthetic::scene(24, 17, 0), {});
  const std::string jpeg = synthetic::flir_jpeg(block, 1000);
  const auto refused = [&](const std::string& bytes) {
    const auto path = folder.file("a.jpg", bytes);
    return refusal_of([&] { open_flir_jpeg(path); });
  };
  std::string without = jpeg;
  without.erase(4 + 16 + 1012, 1012);  // the second part
  EXPECT_TRUE(says(refused(without), "part 2 of 3"));
  EXPECT_TRUE(says(refused("\xFF\xD8\xFF\xDA just a photo"), "carries no radiometric data"));
  EXPECT_TRUE(says(refused(jpeg.substr(0, 1500)), "cut off"));
}

}  // namespace
}  // namespace meltproof::imaging

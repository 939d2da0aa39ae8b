// SPDX-License-Identifier: GPL-3.0-or-later
// Synthetic IRB files: their table gives 250 K + count / 256.
#include "imaging/recording/irb.hpp"

#include <gtest/gtest.h>

#include "imaging/recording/formats.hpp"
#include "imaging/recording/synthetic_files.hpp"
#include "imaging/recording/test_folder.hpp"

namespace meltproof::imaging {
namespace {

TEST(Irb, ReadsASequenceInBothStorages) {
  const TestFolder folder;
  std::vector<synthetic::Picture> frames;
  for (std::size_t i = 0; i < 4; ++i) frames.push_back(synthetic::scene(9, 5, i));
  for (const bool compressed : {false, true}) {
    const auto recording = open_recording(folder.file("a.irb", synthetic::irb(frames, compressed)));
    const auto& h = recording.header();
    EXPECT_EQ(h.format, "InfraTec IRB");
    ASSERT_EQ(h.frames, 4u);
    EXPECT_EQ(h.frames_lost, 0u);
    EXPECT_EQ(h.width, 9u);
    EXPECT_EQ(h.height, 5u);
    EXPECT_NEAR(h.frame_rate, 50, 1e-9);  // 20 ms
    EXPECT_EQ(h.quantity, SignalQuantity::temperature);
    EXPECT_DOUBLE_EQ(h.calibration.at("emissivity"), 0.9);
    EXPECT_EQ(h.under_range, 260);
    EXPECT_EQ(h.saturation, 500);
    for (const std::size_t i : {3u, 0u}) {
      const auto f = recording.frame(i);
      EXPECT_NEAR(f.time, 0.02 * static_cast<double>(i), 1e-9);
      for (std::size_t k = 0; k < f.values.size(); ++k) {
        ASSERT_EQ(f.counts[k], frames[i].counts[k]);
        ASSERT_FLOAT_EQ(f.values[k], 250 + static_cast<float>(frames[i].counts[k]) / 256);
      }
    }
  }
}

TEST(Irb, MarksAPixelBehindTheEndOfTheTableAsDead) {
  const TestFolder folder;
  const synthetic::Picture p{3, 1, {0xFE80, 0xFF00, 0xFF01}};
  const auto f = open_irb(folder.file("a.irb", synthetic::irb({p}, false))).frame(0);
  EXPECT_FLOAT_EQ(f.values[0], 250 + 254.5F);
  EXPECT_FLOAT_EQ(f.values[1], 250 + 255);
  EXPECT_EQ(f.status[2], PixelStatus::dead);
}

TEST(Irb, KeepsWholeFramesAndRefusesWhatItDoesNotKnow) {
  const TestFolder folder;
  const auto p = synthetic::scene(9, 5, 0);
  const std::string whole = synthetic::irb({p, p, p}, false);
  const auto cut = open_irb(folder.file("cut.irb", whole.substr(0, whole.size() - 1)));
  EXPECT_EQ(cut.header().frames, 2u);
  EXPECT_EQ(cut.header().frames_lost, 1u);
  std::string unknown = whole;
  unknown[128 + 2] = 2;
  const auto path = folder.file("unknown.irb", unknown);
  EXPECT_TRUE(says(refusal_of([&] { open_irb(path); }), "kind 2"));
  std::string circle = whole;
  circle[64 + 32 + 12] = 64;  // the chain leads back to itself
  circle[64 + 32 + 13] = 0;
  const auto round = folder.file("circle.irb", circle);
  EXPECT_TRUE(says(refusal_of([&] { open_irb(round); }), "reached twice"));
}

TEST(Irb, RefusesRunsThatEndEarly) {
  const TestFolder folder;
  const auto p = synthetic::scene(9, 5, 0);
  std::string bytes = synthetic::irb({p}, true);
  --bytes[bytes.size() - 2];  // the length of the last run
  const auto recording = open_irb(folder.file("a.irb", bytes));
  EXPECT_TRUE(says(refusal_of([&] { recording.frame(0); }), "after 44 of 45 pixels"));
}

}  // namespace
}  // namespace meltproof::imaging

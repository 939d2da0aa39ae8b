// SPDX-License-Identifier: GPL-3.0-or-later
// Recordings larger than memory: sparse files of 10 GiB, read in constant memory.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "imaging/recording/matlab.hpp"
#include "imaging/recording/ptw.hpp"
#include "imaging/recording/sfmov.hpp"
#include "imaging/recording/synthetic_files.hpp"
#include "imaging/recording/test_folder.hpp"

namespace meltproof::imaging {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t size = 10ULL << 30;

/// The largest memory that the process has had since the last call of forget_peak(), bytes.
std::size_t peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "VmHWM:") {
      std::size_t kilobytes = 0;
      status >> kilobytes;
      return kilobytes * 1024;
    }
  return 0;
}
bool forget_peak() {
  std::ofstream file("/proc/self/clear_refs");
  return static_cast<bool>(file << "5" << std::flush);
}

/// Reads every 1000th frame and the last.
void expect_constant_memory(const Recording& recording, std::size_t frames, float last) {
  ASSERT_EQ(recording.header().frames, frames);
  if (!forget_peak()) GTEST_SKIP() << "the kernel does not tell how much memory was used";
  const std::size_t before = peak_memory();
  Frame frame;
  for (std::size_t i = 0; i < frames; i += 1000) recording.read(i, frame);
  recording.read(frames - 1, frame);
  EXPECT_EQ(frame.values.back(), last);
  EXPECT_LT(peak_memory() - before, 16u << 20);
}

TEST(LargeRecording, SfmovOf10GibIsReadInConstantMemory) {
  const TestFolder folder;
  const auto picture = synthetic::scene(640, 512, 0);
  const auto head = synthetic::sfmov({picture}, "UInt16", 16384);
  const auto path = folder.file("large.sfmov", head);
  const std::uintmax_t frames = size / (2 * 640 * 512);
  const std::uintmax_t start = head.size() - 2 * 640 * 512;
  fs::resize_file(path, start + frames * 2 * 640 * 512 - 2);
  std::ofstream(path, std::ios::binary | std::ios::app) << "\x39\x30";  // 12345
  ASSERT_TRUE(forget_peak());
  const std::size_t before = peak_memory();
  const auto recording = open_sfmov(path);
  EXPECT_LT(peak_memory() - before, 16u << 20);
  expect_constant_memory(recording, frames, 12345);
}

TEST(LargeRecording, PtwOf10GibIsReadInConstantMemory) {
  const TestFolder folder;
  const auto picture = synthetic::scene(96, 40, 0);
  const auto path = folder.file("large.ptw", synthetic::ptw({picture}));
  const std::uintmax_t stride = 128 + 2 * 96 * 40, frames = size / stride;
  fs::resize_file(path, 1024 + frames * stride - 2);
  std::ofstream(path, std::ios::binary | std::ios::app) << "\x39\x30";
  expect_constant_memory(open_ptw(path), frames, 12345);
}

TEST(LargeRecording, Matlab5Of2GibIsReadInPortions) {
  const TestFolder folder;
  const auto picture = synthetic::scene(640, 512, 0);
  std::string head = synthetic::mat5({picture}, false, false, false);
  const std::size_t data = 4 * 640 * 512, tag = head.size() - data - 8;
  const std::uint32_t frames = 1600;  // 2.1 GB of single precision
  const auto put = [&](std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) head[at + i] = static_cast<char>(value >> (8 * i));
  };
  const std::size_t variable = head.find("frames") - 56;  // tag 8, flags 16, dimensions 24, tag 8
  ASSERT_EQ(head[variable], 14);
  put(variable + 4, static_cast<std::uint32_t>(head.size() - variable - 8 + data * (frames - 1)));
  put(variable + 8 + 16 + 8 + 8, frames);
  put(tag + 4, static_cast<std::uint32_t>(data) * frames);
  const auto path = folder.file("large.mat", head);
  fs::resize_file(path, head.size() + std::uintmax_t{data} * (frames - 1) - 4);
  std::ofstream(path, std::ios::binary | std::ios::app) << std::string("\0\xe4@F", 4);  // 12345
  if (!forget_peak()) GTEST_SKIP() << "the kernel does not tell how much memory was used";
  const std::size_t before = peak_memory();
  const auto recording = open_matlab_5(path);
  ASSERT_EQ(recording.header().frames, frames);
  EXPECT_EQ(recording.frame(0).values[5], picture.counts[5]);
  EXPECT_EQ(recording.frame(frames - 1).values.back(), 12345);
  EXPECT_LT(peak_memory() - before, 128u << 20);
}

}  // namespace
}  // namespace meltproof::imaging

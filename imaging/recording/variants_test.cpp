// SPDX-License-Identifier: GPL-3.0-or-later
// What cameras and their software write beside the plain form of a format, in synthetic files: no
// real one of these is at hand.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <hdf5.h>

#include "imaging/recording/formats.hpp"
#include "imaging/recording/synthetic_files.hpp"
#include "imaging/recording/test_folder.hpp"

namespace meltproof::imaging {
namespace {

using synthetic::Pixels;

std::vector<float> as_float(const synthetic::Picture& p) {
  return {p.counts.begin(), p.counts.end()};
}

std::vector<synthetic::Picture> film(std::size_t frames = 3) {
  std::vector<synthetic::Picture> pictures;
  for (std::size_t i = 0; i < frames; ++i) pictures.push_back(synthetic::scene(24, 17, i));
  return pictures;
}

bool has_note(const Recording& recording, const std::string& part) {
  const auto& notes = recording.header().notes;
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

/// All counts (the values where there are none) are those of the film.
void expect_film(const Recording& recording, std::size_t frames = 3) {
  ASSERT_EQ(recording.header().frames, frames);
  for (std::size_t i = frames; i-- > 0;) {
    const auto f = recording.frame(i);
    ASSERT_EQ(f.counts.empty() ? f.values : f.counts, as_float(synthetic::scene(24, 17, i))) << i;
  }
}

std::string flir_film(const synthetic::FlirBlock& options, const std::string& between = "") {
  std::string file;
  for (const auto& picture : film()) {
    if (!file.empty()) file += between;
    file += synthetic::flir_block(picture, options);
  }
  return file;
}

TEST(FlirVariants, ReadsADirectoryBehindTheRecords) {
  const TestFolder folder;
  for (const bool big : {false, true})
    expect_film(open_recording(folder.file(
        "a.seq", flir_film({.big_header = big, .big_records = big, .directory_behind = true}))));
}

TEST(FlirVariants, LeavesOutBytesBetweenFramesEvenIfTheyLookLikeABeginning) {
  const TestFolder folder;
  const std::string lookalike("\0FFF\0 four letters make no frame, nor AFF\0", 42);
  for (const std::string& between : {std::string(13, '\0'), lookalike, std::string(1 << 20, 'F')}) {
    const auto recording = open_recording(folder.file("a.seq", flir_film({}, between)));
    expect_film(recording);
    EXPECT_EQ(recording.header().frames_lost, 0u);
    EXPECT_TRUE(has_note(recording, std::to_string(2 * between.size()) + " bytes between"));
  }
}

TEST(FlirVariants, ReadsTheShorterRecordsOfOlderCameras) {
  const TestFolder folder;
  const auto dated = open_recording(folder.file("a.seq", flir_film({.camera_length = 0x400})));
  expect_film(dated);
  EXPECT_EQ(dated.header().quantity, SignalQuantity::temperature);
  EXPECT_EQ(dated.header().frame_rate, 0);
  const auto timeless = open_recording(folder.file("b.seq", flir_film({.camera_length = 0x310})));
  expect_film(timeless);
  EXPECT_EQ(timeless.frame(2).time, 0);
  const auto whole = open_recording(folder.file("c.seq", flir_film({})));
  EXPECT_EQ(timeless.frame(1).values, whole.frame(1).values);
  const auto cut = folder.file("d.seq", flir_film({.camera_length = 0x30F}));
  EXPECT_TRUE(says(refusal_of([&] { open_recording(cut); }), "783 bytes of camera information"));
}

TEST(FlirVariants, TakesTheFirstCalibrationWhereLaterFramesHaveNone) {
  const TestFolder folder;
  const auto picture = synthetic::scene(24, 17, 1);
  const auto recording =
      open_recording(folder.file("a.csq", synthetic::flir_block(synthetic::scene(24, 17, 0), {}) +
                                              synthetic::flir_block(picture, {.camera = false})));
  const auto both =
      open_recording(folder.file("b.csq", synthetic::flir_block(synthetic::scene(24, 17, 0), {}) +
                                              synthetic::flir_block(picture, {})));
  EXPECT_EQ(recording.frame(1).values, both.frame(1).values);
}

TEST(FlirVariants, JudgesTheByteOrderWhereTheFileContradictsItself) {
  const TestFolder folder;
  for (const bool big : {false, true}) {
    const auto right = open_recording(folder.file(
        "a.seq",
        flir_film({.big_records = big, .subtype = static_cast<std::uint16_t>(big ? 2 : 1)})));
    expect_film(right);
    EXPECT_TRUE(has_note(right, "regular bytes, judged by which order is smoother"));
  }
  // Pixels the other way round than the record says of itself, but as the subtype says.
  std::string file = flir_film({});
  const std::size_t block = file.size() / 3, pixels = block - 2 * 24 * 17;
  for (std::size_t i = 0; i < 3; ++i) {
    file[i * block + 64 + 2 * 32 + 2] = 1;
    for (std::size_t at = i * block + pixels; at < (i + 1) * block; at += 2)
      std::swap(file[at], file[at + 1]);
  }
  const auto turned = open_recording(folder.file("b.seq", file));
  expect_film(turned);
  EXPECT_TRUE(has_note(turned, "exchanged bytes"));
}

TEST(FlirVariants, ReadsJpegLsWithExchangedBytes) {
  const TestFolder folder;
  const auto recording =
      open_recording(folder.file("a.csq", flir_film({.pixels = Pixels::jpeg_ls_exchanged})));
  expect_film(recording);
  EXPECT_TRUE(has_note(recording, "as JPEG-LS with exchanged bytes"));
}

TEST(FlirVariants, LeavesOutRowsBehindThePicture) {
  const TestFolder folder;
  expect_film(open_recording(folder.file("a.seq", flir_film({.extra_rows = 2}))));
  const auto path = folder.file("b.seq", flir_film({.extra_rows = 65}));
  EXPECT_TRUE(
      says(refusal_of([&] { open_recording(path); }), "24 x 17 pixels, but its record has"));
}

TEST(PtwVariants, FindsTheStepFromFrameToFrameByTheSizeOfTheFile) {
  const TestFolder folder;
  const std::string file = synthetic::ptw(film(), 50);
  expect_film(open_recording(folder.file("a.ptw", file)));
  // Cut off, nothing tells the step any more.
  const auto cut = folder.file("b.ptw", file.substr(0, file.size() - 1));
  EXPECT_TRUE(says(refusal_of([&] { open_recording(cut); }), "contradicts itself"));
}

TEST(PtwVariants, MarksTheRowOfALockInReferenceAsDead) {
  const TestFolder folder;
  auto frames = film();
  for (auto& f : frames) {
    const std::uint16_t marks[] = {1220, 3907, 1204, 2382};
    std::copy(std::begin(marks), std::end(marks), f.counts.begin());
  }
  const auto recording = open_recording(folder.file("a.ptw", synthetic::ptw(frames)));
  EXPECT_TRUE(has_note(recording, "lock-in"));
  const auto f = recording.frame(2);
  for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(f.status[i], PixelStatus::dead);
  EXPECT_NE(f.status[24], PixelStatus::dead);
  EXPECT_EQ(f.values[24], static_cast<float>(frames[2].counts[24]));
}

TEST(PtwVariants, ReadsASignatureFilledWithBlanks) {
  const TestFolder folder;
  std::string file = synthetic::ptw(film());
  file[3] = file[4] = ' ';
  expect_film(open_recording(folder.file("a.ptw", file)));
  file[381] = 0;  // bits of the converter
  const auto recording = open_recording(folder.file("b.ptw", file));
  expect_film(recording);
  EXPECT_EQ(recording.header().saturation, 65535);
}

TEST(TiffVariants, ReadsTheFramesThatImageJPutsBehindASinglePage) {
  const TestFolder folder;
  const std::string file = synthetic::imagej_stack(film(5), 5);
  const auto recording = open_recording(folder.file("a.tif", file));
  expect_film(recording, 5);
  EXPECT_EQ(recording.header().frames_lost, 0u);
  EXPECT_DOUBLE_EQ(recording.header().frame_rate, 500);
  const auto cut = open_recording(folder.file("b.tif", file.substr(0, file.size() - 1)));
  expect_film(cut, 4);
  EXPECT_EQ(cut.header().frames_lost, 1u);
}

TEST(TiffVariants, ReadsPackedSamplesAndWhiteAsZero) {
  const TestFolder folder;
  const auto picture = synthetic::scene(25, 7, 0);  // rows end within a byte
  for (const bool white : {false, true}) {
    const auto recording = open_recording(folder.file("a.tif", synthetic::tiff_12(picture, white)));
    EXPECT_EQ(recording.header().saturation, 4095);
    const auto f = recording.frame(0);
    for (std::size_t i = 0; i < picture.counts.size(); ++i) {
      const int stored = picture.counts[i] / 16;
      ASSERT_EQ(f.values[i], static_cast<float>(white ? 4095 - stored : stored)) << i;
    }
  }
}

TEST(MatlabVariants, ReadsVariablesThatAreTheFrames) {
  const TestFolder folder;
  for (const bool compressed : {false, true}) {
    // Frame10 comes before Frame2 in the file.
    const std::string file = synthetic::mat5_frames(film(12), compressed);
    const auto recording = open_recording(folder.file("a.mat", file));
    expect_film(recording, 12);
    EXPECT_TRUE(has_note(recording, "the 12 variables Frame0 to Frame11 of shape 17 x 24"));
    expect_film(open_recording(folder.file("a.mat", file), {.dataset = "Frame0"}), 1);
  }
  // The last variable of the file is Frame2's clock, and the one before it Frame2.
  const std::string file = synthetic::mat5_frames(film(3), false);
  const auto cut = open_recording(folder.file("b.mat", file.substr(0, file.size() - 400)));
  expect_film(cut, 2);
  EXPECT_EQ(cut.header().frames_lost, 1u);
}

TEST(MatlabVariants, PassesOverADimensionOfOneChannel) {
  const TestFolder folder;
  for (const bool compressed : {false, true}) {
    const std::string file = synthetic::mat5(film(5), compressed, false, true, true);
    expect_film(open_recording(folder.file("a.mat", file)), 5);
  }
  const std::string file = synthetic::mat5(film(5), false, false, true, true);
  const auto cut = open_recording(folder.file("b.mat", file.substr(0, file.size() - 9)));
  expect_film(cut, 4);
  EXPECT_EQ(cut.header().frames_lost, 1u);
}

TEST(Hdf5Variants, PassesOverADimensionOfOneChannelAndReadsArraysThatAreTheFrames) {
  const TestFolder folder;
  const auto write = [](hid_t file, const std::string& name, const std::vector<hsize_t>& dims,
                        const std::vector<synthetic::Picture>& frames) {
    const hid_t space = H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr);
    const hid_t set =
        H5Dcreate2(file, name.c_str(), H5T_STD_U16LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    std::vector<std::uint16_t> all;
    for (const auto& f : frames) all.insert(all.end(), f.counts.begin(), f.counts.end());
    if (!all.empty()) H5Dwrite(set, H5T_NATIVE_UINT16, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data());
    H5Dclose(set);
    H5Sclose(space);
  };
  // Each in a file of its own: HDF5 makes no file anew that is still open.
  const auto file = [&](const char* name, const auto& fill) {
    const auto path = folder.path() / name;
    const hid_t id = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    fill(id);
    H5Fclose(id);
    return open_recording(path);
  };
  expect_film(file("a.h5", [&](hid_t id) { write(id, "video", {5, 17, 24, 1}, film(5)); }), 5);
  const auto series = file("b.h5", [&](hid_t id) {
    for (std::size_t i = 0; i < 11; ++i)
      write(id, "image_" + std::to_string(i), {17, 24}, {synthetic::scene(24, 17, i)});
  });
  expect_film(series, 11);
  EXPECT_TRUE(has_note(series, "the 11 arrays image_0 to image_10 of shape 17 x 24"));
  // What was never written is no picture of zeros.
  const auto begun = file("c.h5", [&](hid_t id) {
    write(id, "image_1", {17, 24}, {synthetic::scene(24, 17, 0)});
    write(id, "image_2", {17, 24}, {});
  });
  EXPECT_EQ(begun.frame(0).values, as_float(synthetic::scene(24, 17, 0)));
  EXPECT_TRUE(says(refusal_of([&] { begun.frame(1); }), "image_2 was never written whole"));
  const auto empty = file("d.h5", [&](hid_t id) { write(id, "picture", {17, 24}, {}); });
  EXPECT_TRUE(says(refusal_of([&] { empty.frame(0); }), "picture was never written whole"));
}

}  // namespace
}  // namespace meltproof::imaging

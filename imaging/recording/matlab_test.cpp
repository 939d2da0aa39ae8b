// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays in synthetic HDF5 and MATLAB files.
#include "imaging/recording/matlab.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>

#include "base/atomic_file.hpp"
#include "imaging/recording/formats.hpp"
#include "imaging/recording/synthetic_files.hpp"
#include "imaging/recording/test_folder.hpp"

namespace meltproof::imaging {
namespace {

std::vector<synthetic::Picture> film() {
  std::vector<synthetic::Picture> frames;
  for (std::size_t i = 0; i < 5; ++i) frames.push_back(synthetic::scene(9, 6, i));
  return frames;
}

void expect_film(const Recording& recording, std::size_t frames = 5) {
  ASSERT_EQ(recording.header().frames, frames);
  ASSERT_EQ(recording.header().width, 9u);
  ASSERT_EQ(recording.header().height, 6u);
  for (std::size_t i = frames; i-- > 0;) {
    const auto p = synthetic::scene(9, 6, i);
    ASSERT_EQ(recording.frame(i).values, std::vector<float>(p.counts.begin(), p.counts.end())) << i;
  }
}

TEST(Hdf5Array, FindsTheOnlyStackAndTakesANamedOne) {
  const TestFolder folder;
  const auto path = folder.path() / "a.h5";
  for (const bool chunked : {false, true}) {
    synthetic::write_hdf5(path, "scan/frames", film(), chunked);
    const auto recording = open_recording(path);
    EXPECT_EQ(recording.header().format, "HDF5");
    expect_film(recording);
    expect_film(open_recording(path, {.dataset = "scan/frames"}));
    EXPECT_TRUE(says(recording.header().notes[0], "scan/frames of shape 5 x 6 x 9, taken as fhw"));
  }
  EXPECT_TRUE(says(refusal_of([&] { open_recording(path, {.dataset = "nothing"}); }),
                   "no data set nothing"));
  EXPECT_TRUE(says(refusal_of([&] { open_recording(path, {.axes = "abc"}); }), "\"abc\""));
  const auto turned = open_recording(path, {.axes = "hwf"});
  EXPECT_EQ(turned.header().frames, 9u);
  EXPECT_EQ(turned.header().height, 5u);
  EXPECT_EQ(turned.frame(4).values[3 * 6 + 2],
            static_cast<float>(synthetic::scene(9, 6, 3).counts[2 * 9 + 4]));
}

TEST(Hdf5Array, CountsFramesThatWereNeverWritten) {
  const TestFolder folder;
  const auto path = folder.path() / "a.h5";
  for (const hsize_t announced : {hsize_t{8}, hsize_t{1} << 50}) {  // broken off after 5
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hsize_t dims[3] = {announced, 6, 9}, chunk[3] = {1, 6, 9}, start[3] = {0, 0, 0},
                  count[3] = {5, 6, 9};
    const hid_t space = H5Screate_simple(3, dims, nullptr),
                memory = H5Screate_simple(3, count, nullptr);
    const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(layout, 3, chunk);
    const hid_t set =
        H5Dcreate2(file, "frames", H5T_STD_U16LE, space, H5P_DEFAULT, layout, H5P_DEFAULT);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count, nullptr);
    std::vector<std::uint16_t> all;
    for (const auto& f : film()) all.insert(all.end(), f.counts.begin(), f.counts.end());
    H5Dwrite(set, H5T_NATIVE_UINT16, memory, space, H5P_DEFAULT, all.data());
    H5Dclose(set);
    H5Pclose(layout);
    H5Sclose(memory);
    H5Sclose(space);
    H5Fclose(file);
    const auto recording = open_recording(path);
    expect_film(recording);
    EXPECT_EQ(recording.header().frames_lost, announced - 5);
  }
}

TEST(Hdf5Array, PassesOverAListOfTextsWhereOneIsExpected) {
  const TestFolder folder;
  const auto path = folder.path() / "a.h5";
  synthetic::write_hdf5(path, "frames", film(), false);
  {
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hsize_t many = 1000;
    const hid_t space = H5Screate_simple(1, &many, nullptr), type = H5Tcopy(H5T_C_S1);
    const hid_t set = H5Dopen2(file, "frames", H5P_DEFAULT);
    for (const auto& [object, name] : {std::pair{file, "kind"}, {set, "units"}}) {
      const hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
      H5Awrite(attribute, type, std::string(many, 'K').data());
      H5Aclose(attribute);
    }
    H5Dclose(set);
    H5Tclose(type);
    H5Sclose(space);
    H5Fclose(file);
  }
  expect_film(open_recording(path));
}

TEST(Matlab, ReadsVersion7WithItsAxesTurnedRound) {
  const TestFolder folder;
  const auto path = folder.path() / "a.mat";
  synthetic::write_matlab_7(path, film());
  const auto recording = open_recording(path);
  EXPECT_EQ(recording.header().format, "MATLAB 7.3");
  expect_film(recording);
  EXPECT_TRUE(says(recording.header().notes[0], "frames of shape 6 x 9 x 5, taken as hwf"));
}

TEST(Matlab, ReadsVersion5HoweverItIsStored) {
  const TestFolder folder;
  for (const bool compressed : {false, true})
    for (const bool big : {false, true})
      for (const bool doubles : {false, true}) {
        const auto path = folder.file("a.mat", synthetic::mat5(film(), compressed, big, doubles));
        const auto recording = open_recording(path);
        EXPECT_EQ(recording.header().format, "MATLAB 5");
        expect_film(recording);
        expect_film(open_recording(path, {.dataset = "frames"}));
      }
}

TEST(Matlab, ReadsWhatScipyAndH5pyHaveWritten) {
  // Two frames of 4 x 3 pixels with the value 100 frame + 10 row + column, compressed.
  const auto mat = open_recording("imaging/fuzz/corpus/matlab_5/scipy.mat");
  const auto h5 = open_recording("imaging/fuzz/corpus/hdf5/h5py.h5");  // in Celsius
  for (const auto* recording : {&mat, &h5}) {
    ASSERT_EQ(recording->header().frames, 2u);
    ASSERT_EQ(recording->header().width, 4u);
    ASSERT_EQ(recording->header().height, 3u);
    for (std::size_t f = 0; f < 2; ++f)
      for (std::size_t i = 0; i < 12; ++i)
        EXPECT_FLOAT_EQ(
            recording->frame(f).values[i],
            static_cast<float>(100 * f + 10 * (i / 4) + i % 4) + (recording == &h5 ? 273.15F : 0));
  }
  EXPECT_EQ(h5.header().unit, "K");
}

TEST(Matlab, KeepsTheWholeFramesOfAVersion5ThatIsCutOff) {
  const TestFolder folder;
  const std::string whole = synthetic::mat5(film(), false);
  const auto cut =
      open_recording(folder.file("a.mat", whole.substr(0, whole.size() - 9 * 6 * 8 - 3)));
  expect_film(cut, 3);
  EXPECT_EQ(cut.header().frames_lost, 2u);
  const std::string packed = synthetic::mat5(film(), true);
  const auto path = folder.file("b.mat", packed.substr(0, packed.size() - 200));
  EXPECT_TRUE(says(refusal_of([&] { open_recording(path).frame(4); }), "cut off"));
}

TEST(Matlab, RefusesWithASentence) {
  const TestFolder folder;
  const std::string whole = synthetic::mat5(film(), false);
  const auto refused = [&](const std::string& bytes, const ReadOptions& options = {}) {
    const auto path = folder.file("a.mat", bytes);
    return refusal_of([&] { open_recording(path, options); });
  };
  EXPECT_TRUE(says(refused(whole, {.dataset = "rate"}), "no variable rate"));
  EXPECT_TRUE(says(refused(whole.substr(0, 230)), "ends within"));
  std::string odd = whole;
  odd[128] = 77;
  EXPECT_TRUE(says(refused(odd), "of type 77"));
}

TEST(Matlab, RefusesADamagedCompressedVariable) {
  const TestFolder folder;
  const std::string packed = synthetic::mat5(film(), true);
  std::size_t refused = 0;
  for (std::size_t at = packed.size() - 400; at < packed.size() - 40; at += 8) {
    std::string bad = packed;
    bad[at] = static_cast<char>(bad[at] ^ 0x55);
    const auto path = folder.file("a.mat", bad);
    const auto text = refusal_of([&] {
      const auto recording = open_recording(path);
      for (std::size_t i = 0; i < recording.header().frames; ++i) recording.frame(i);
    });
    refused += text.empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 30u);  // of 45: DEFLATE itself notices most damage
}

}  // namespace
}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// Every file of the corpus, and every file that once brought a reader down, through every reader.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "imaging/fuzz/read_everything.hpp"

namespace meltproof::imaging {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::is_directory(folder)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

TEST(Replay, EverySeedIsReadByItsReader) {
  for (const auto& reader : reader_names()) {
    const auto seeds = files_below(fs::path("imaging/fuzz/seeds") / reader);
    ASSERT_FALSE(seeds.empty()) << "there is no seed for " << reader;
    for (const auto& seed : seeds) EXPECT_EQ(read_everything(reader, seed), Outcome::read) << seed;
  }
}

TEST(Replay, NoFileBringsAReaderDown) {
  std::size_t files = 0;
  for (const char* folder : {"imaging/fuzz/seeds", "imaging/fuzz/corpus", "imaging/fuzz/crashes"})
    for (const auto& file : files_below(folder)) {
      ++files;
      for (const auto& reader : reader_names()) {
        const auto start = std::chrono::steady_clock::now();
        EXPECT_NO_THROW(read_everything(reader, file)) << reader << " " << file;
        const auto taken = std::chrono::steady_clock::now() - start;
        EXPECT_LT(taken, std::chrono::seconds(5)) << reader << " " << file;
      }
    }
  EXPECT_GE(files, reader_names().size());
}

}  // namespace
}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// Every file of the corpus, and every file that once brought a reader down, through every reader.
#include <algorithm>
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

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

/// s that the processor spent on this program and on the child processes that it has waited for. A
/// clock on the wall would also count what a busy machine lets a program wait.
double processor_time() {
  double sum = 0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used{};
    ::getrusage(who, &used);
    for (const auto& t : {used.ru_utime, used.ru_stime})
      sum += static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  }
  return sum;
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
        const double start = processor_time();
        EXPECT_NO_THROW(read_everything(reader, file)) << reader << " " << file;
        EXPECT_LT(processor_time() - start, 5) << reader << " " << file;
      }
    }
  EXPECT_GE(files, reader_names().size());
}

}  // namespace
}  // namespace meltproof::imaging

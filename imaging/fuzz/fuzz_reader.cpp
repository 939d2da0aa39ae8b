// SPDX-License-Identifier: GPL-3.0-or-later
// The libFuzzer target of one reader, which the build names in MELTPROOF_FUZZ_READER.
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <fcntl.h>
#include <unistd.h>

#include "imaging/fuzz/read_everything.hpp"

namespace {

/// A file in memory, in a folder of its own: readers take paths and look for files beside them, and
/// a disk would be the slowest part.
class MemoryFile {
 public:
  MemoryFile() : folder_("/dev/shm/meltproof-fuzz-" + std::to_string(getpid())) {
    std::filesystem::create_directory(folder_);
    descriptor_ = open(path().c_str(), O_RDWR | O_CREAT, 0600);
    if (descriptor_ < 0) std::abort();
  }
  ~MemoryFile() { std::filesystem::remove_all(folder_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::filesystem::path path() const { return folder_ / "input"; }
  void fill(const std::uint8_t* data, std::size_t size) const {
    if (ftruncate(descriptor_, 0) != 0 ||
        pwrite(descriptor_, data, size, 0) != static_cast<ssize_t>(size))
      std::abort();
  }

 private:
  std::filesystem::path folder_;
  int descriptor_ = -1;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const MemoryFile file;
  file.fill(data, size);
  const auto outcome = meltproof::imaging::read_everything(MELTPROOF_FUZZ_READER, file.path());
  // What the reader does not recognise is not worth keeping as an ancestor.
  return outcome == meltproof::imaging::Outcome::foreign ? -1 : 0;
}

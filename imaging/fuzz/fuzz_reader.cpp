// SPDX-License-Identifier: GPL-3.0-or-later
// The libFuzzer target of one reader, which the build names in MELTPROOF_FUZZ_READER.
#include <cstdint>
#include <cstdlib>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include "imaging/fuzz/read_everything.hpp"

namespace {

/// A file in memory, made once: readers take paths, and a disk would be the slowest part.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(memfd_create("fuzz", 0)) {
    if (descriptor_ < 0) std::abort();
  }
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }
  void fill(const std::uint8_t* data, std::size_t size) const {
    if (ftruncate(descriptor_, 0) != 0 ||
        pwrite(descriptor_, data, size, 0) != static_cast<ssize_t>(size))
      std::abort();
  }

 private:
  int descriptor_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const MemoryFile file;
  file.fill(data, size);
  const auto outcome = meltproof::imaging::read_everything(MELTPROOF_FUZZ_READER, file.path());
  // What the reader does not recognise is not worth keeping as an ancestor.
  return outcome == meltproof::imaging::Outcome::foreign ? -1 : 0;
}

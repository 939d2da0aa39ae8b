// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are there whole or not at all.
#pragma once

#include <filesystem>
#include <string>

namespace meltproof {

/// A temporary name beside `place`; commit() renames it to `place`, destruction without commit()
/// removes it. For writers of other libraries (images, HDF5) that take a path. The temporary name
/// keeps the extension, because such writers choose the format by it.
class AtomicFile {
 public:
  /// Makes the parent folder if it is missing. @throws InputError if that fails.
  explicit AtomicFile(std::filesystem::path place);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  const std::filesystem::path& temporary() const { return temporary_; }
  const std::filesystem::path& place() const { return place_; }
  /// @throws std::runtime_error with a sentence if the rename fails.
  void commit();

 private:
  std::filesystem::path place_, temporary_;
  bool committed_ = false;
};

/// Writes a whole text file atomically. @throws std::runtime_error with a sentence (disk full).
void write_file(const std::filesystem::path& place, const std::string& content);
/// The bytes of a file. @throws InputError naming it if it is missing or unreadable.
std::string read_file(const std::filesystem::path& path);

}  // namespace meltproof

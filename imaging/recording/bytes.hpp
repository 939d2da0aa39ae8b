// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes of a file at given places, in a given order.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace meltproof::imaging {

/// A file open for reading at any place. Copies share the open file.
class ByteFile {
 public:
  /// @throws InputError if the file is missing or unreadable.
  explicit ByteFile(const std::filesystem::path& path);
  /// A file within the file `path`, taken out of it: `content` is all of its bytes.
  ByteFile(std::filesystem::path path, std::string content);
  std::uint64_t size() const { return size_; }
  const std::filesystem::path& path() const { return path_; }
  /// `count` bytes from `offset` on. @throws InputError if the file ends before.
  std::string bytes(std::uint64_t offset, std::uint64_t count) const;
  /// The first `most` bytes, or all if there are fewer: what a format is recognised by.
  std::string beginning(std::uint64_t most) const;
  /// The same as bytes() into memory of the caller.
  void read(std::uint64_t offset, std::uint64_t count, char* into) const;

 private:
  std::filesystem::path path_;
  std::uint64_t size_ = 0;
  std::shared_ptr<std::ifstream> stream_;
  std::shared_ptr<const std::string> content_;  // instead of the stream
};

/// The number at `offset` of `bytes`, stored in byte order `order`. The caller has checked that
/// offset + sizeof(T) <= bytes.size().
template <class T>
T number_at(const std::string& bytes, std::size_t offset, std::endian order) {
  static_assert(std::is_arithmetic_v<T>);
  char raw[sizeof(T)];
  for (std::size_t i = 0; i < sizeof(T); ++i)
    raw[order == std::endian::native ? i : sizeof(T) - 1 - i] = bytes.at(offset + i);
  T value;
  std::memcpy(&value, raw, sizeof(T));
  return value;
}

/// The decimal number that a stored float was meant to be: 0.01 for the float nearest to 0.01.
double decimal(float value);

/// Unsigned 16-bit values at the beginning of `bytes` as numbers.
void widen(const std::string& bytes, std::endian order, std::vector<float>& into);

}  // namespace meltproof::imaging

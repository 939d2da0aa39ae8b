// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes of a synthetic file, written at given places in a given order.
#pragma once

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

namespace meltproof::imaging::synthetic {

/// The bytes of a file while it is made.
struct Bytes {
  std::string text;

  /// Replaces what stands at `at`; the bytes must be there already.
  template <class T>
  void put(std::size_t at, T value, bool big = false) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (big != (std::endian::native == std::endian::big)) std::reverse(raw, raw + sizeof(T));
    text.replace(at, sizeof(T), raw, sizeof(T));
  }
  /// Appends.
  template <class T>
  void add(T value, bool big = false) {
    text.resize(text.size() + sizeof(T));
    put(text.size() - sizeof(T), value, big);
  }
};

/// Replaces the first bytes of a file.
inline void overwrite_beginning(const std::filesystem::path& path, const std::string& bytes) {
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace meltproof::imaging::synthetic

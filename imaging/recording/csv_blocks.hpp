// SPDX-License-Identifier: GPL-3.0-or-later
// Where the frames of a text file lie.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "imaging/recording/bytes.hpp"
#include "imaging/recording/csv_row.hpp"

namespace meltproof::imaging {

/// Rows of one length without anything between them.
struct CsvBlock {
  std::uint64_t place = 0;  ///< byte of the first row
  std::size_t line = 0;     ///< of the first row, counted from 1
  std::size_t rows = 0, width = 0;
};

/// The lines of a file one after another, in little memory.
class LineReader {
 public:
  LineReader(const ByteFile& file, std::uint64_t place) : file_(file), next_(place) {}
  /// The next line without its end; false behind the last. The view holds until the next call.
  /// @throws InputError for a line longer than 64 MiB.
  bool next(std::string_view& line);
  /// The byte at which the line last read begins.
  std::uint64_t place() const { return place_; }

 private:
  const ByteFile& file_;
  std::uint64_t next_, place_ = 0;  // bytes of the file
  std::string buffer_;
  std::uint64_t buffer_place_ = 0;
};

/// Every block of the file in order, `skip` lines left out at its beginning. The lines that are no
/// rows are appended to `preamble`, up to 64 KiB.
/// @throws InputError if a line beside a row is like it but for a word: a row would be lost.
std::vector<CsvBlock> find_csv_blocks(const ByteFile& file, const CsvDialect& dialect,
                                      std::size_t skip, std::string& preamble);

}  // namespace meltproof::imaging

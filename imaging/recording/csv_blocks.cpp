// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/csv_blocks.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.hpp"
#include "imaging/recording/csv_labels.hpp"

namespace meltproof::imaging {
namespace {

constexpr std::uint64_t chunk = 1 << 18, longest_line = 64 << 20;
constexpr std::size_t longest_preamble = 64 << 10;

}  // namespace

bool LineReader::next(std::string_view& line) {
  if (next_ >= file_.size()) return false;
  place_ = next_;
  std::uint64_t searched = place_;
  for (;;) {
    const auto at = static_cast<std::size_t>(searched - buffer_place_);
    const auto end = searched < buffer_place_ || at >= buffer_.size() ? std::string::npos
                                                                      : buffer_.find('\n', at);
    const std::uint64_t buffer_end = buffer_place_ + buffer_.size();
    const auto begin = static_cast<std::size_t>(place_ - buffer_place_);
    if (end != std::string::npos) {
      line = std::string_view(buffer_).substr(begin, end - begin);
      next_ = buffer_place_ + end + 1;
      return true;
    }
    if (buffer_end >= file_.size() && !buffer_.empty()) {  // the last line has no end
      line = std::string_view(buffer_).substr(begin);
      next_ = file_.size();
      return true;
    }
    if (buffer_end > place_ && buffer_end - place_ > longest_line)
      throw InputError(
          fmt::format("{}: the line at byte {} is longer than {} MiB; this is no "
                      "export of frames as text.",
                      file_.path().string(), place_, longest_line >> 20));
    // What is left of the buffer is kept: a line may be longer than one chunk.
    const std::uint64_t from = buffer_.empty() ? place_ : buffer_end;
    if (!buffer_.empty()) buffer_.erase(0, begin);
    buffer_place_ = place_;
    searched = from;
    buffer_ += file_.bytes(
        from, std::min(std::max<std::uint64_t>(chunk, buffer_.size()), file_.size() - from));
  }
}

std::vector<CsvBlock> find_csv_blocks(const ByteFile& file, const CsvDialect& dialect,
                                      std::size_t skip, std::string& preamble) {
  std::vector<CsvBlock> blocks;
  std::vector<float> values;
  bool open = false;           // whether the last block may go on
  std::size_t odd_fields = 0;  // of the line before, if it mixes numbers and words
  CsvWord odd_word;            // its first word
  LineReader reader(file, 0);
  std::string_view line;
  const auto refuse = [&](std::size_t number, const CsvWord& word) {
    constexpr std::size_t shown = 40;
    const std::string text =
        word.text.size() > shown ? word.text.substr(0, shown) + "..." : word.text;
    throw InputError(
        fmt::format("{}: line {}, column {}: \"{}\" is no number, but the line has as many fields "
                    "as the rows of a frame beside it; repair it, or say how many lines of "
                    "preamble there are (preamble_lines).",
                    file.path().string(), number, word.column, text));
  };
  for (std::size_t number = 1; reader.next(line); ++number) {
    const CsvLine kind = number <= skip ? CsvLine::other : read_csv_line(line, dialect, values);
    if (kind != CsvLine::row) {
      const bool mixed = kind == CsvLine::mixed;
      odd_word = mixed ? first_csv_word(line, dialect) : CsvWord();
      odd_fields = mixed ? values.size() : 0;
      if (mixed && open && odd_fields == blocks.back().width) refuse(number, odd_word);
      open = false;
      if (preamble.size() + line.size() < longest_preamble) preamble.append(line).append("\n");
      continue;
    }
    if (odd_fields == values.size()) refuse(number - 1, odd_word);
    odd_fields = 0;
    if (csv_row_begins_frame(line, dialect)) open = false;
    if (!open || blocks.back().width != values.size())
      blocks.push_back({reader.place(), number, 0, values.size()});
    ++blocks.back().rows;
    open = true;
  }
  return blocks;
}

}  // namespace meltproof::imaging

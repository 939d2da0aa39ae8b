// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/csv.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "imaging/recording/bytes.hpp"
#include "imaging/recording/csv_blocks.hpp"
#include "imaging/recording/csv_commas.hpp"
#include "imaging/recording/csv_numbers.hpp"
#include "imaging/recording/csv_row.hpp"
#include "imaging/recording/signal_unit.hpp"

namespace meltproof::imaging {
namespace {

constexpr std::uint64_t sample_size = 1 << 18;

/// The beginning of a text up to its last whole value.
std::string_view whole_values(std::string_view text) {
  const auto end = text.find_last_of("\n;\t, ");
  return end == std::string_view::npos ? text : text.substr(0, end);
}

constexpr std::string_view little_mark = "\xFF\xFE", big_mark = "\xFE\xFF";

bool is_utf16(std::string_view text) {
  return text.starts_with(little_mark) || text.starts_with(big_mark);
}

/// Text of 16-bit characters as bytes: what is no ASCII is none of the signs that numbers have, and
/// becomes its Latin-1 byte, or a question mark.
std::string as_bytes(std::string_view utf16) {
  const std::size_t low = utf16.starts_with(little_mark) ? 0 : 1;
  std::string text;
  text.reserve(utf16.size() / 2);
  for (std::size_t i = 2; i + 1 < utf16.size(); i += 2)
    text += utf16[i + 1 - low] == '\0' ? utf16[i + low] : '?';
  return text;
}

ByteFile open_text(const std::filesystem::path& path) {
  const ByteFile file(path);
  if (!is_utf16(file.beginning(2))) return file;
  return {path, as_bytes(file.bytes(0, file.size()))};
}

/// The shape that holds most values.
std::pair<std::size_t, std::size_t> main_shape(const std::vector<CsvBlock>& blocks) {
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> values;
  std::pair<std::size_t, std::size_t> best{0, 0};
  for (const auto& block : blocks) {
    const std::pair shape{block.rows, block.width};
    const std::size_t count = values[shape] += block.rows * block.width;
    if (count > values[best]) best = shape;
  }
  return best;
}

/// A frame that begins with row `first` of a block.
struct Place {
  std::uint64_t place = 0;
  std::size_t first = 0;
};

/// Refuses a row with nearly as many values as those beside it, where these make no whole frame: a
/// value is missing in it, or one too many, and the frame would go by as lost. The last line may be
/// cut off. A row with few values is a line between frames, their number and time.
void refuse_uneven_rows(const ByteFile& file, const std::vector<CsvBlock>& blocks,
                        const RecordingHeader& header) {
  const auto torn = [&](std::size_t first, std::size_t whole) {
    return blocks[first].line + blocks[first].rows == blocks[first + 1].line &&
           blocks[whole].width == header.width && blocks[whole].rows % header.height != 0;
  };
  for (std::size_t i = 0; i + 1 < blocks.size(); ++i) {
    const auto& block = blocks[i];
    if (block.rows != 1 || block.width == header.width || 2 * block.width <= header.width) continue;
    if ((i > 0 && torn(i - 1, i - 1)) || torn(i, i + 1))
      throw InputError(
          fmt::format("{}: line {} has {} values where the rows beside it have {}; repair it, or "
                      "say how many lines of preamble there are (preamble_lines).",
                      file.path().string(), block.line, block.width, header.width));
  }
}

/// Sorts the blocks into frames, preamble and what was cut off.
std::vector<Place> frames_of(const ByteFile& file, const std::vector<CsvBlock>& blocks,
                             const ReadOptions& options, RecordingHeader& header) {
  const auto [rows, width] = main_shape(blocks);
  header.width = width;
  header.height = options.frame_rows.value_or(rows);
  if (header.height == 0)
    throw InputError(file.path().string() +
                     ": frames of 0 rows were asked for; give the number of rows of a frame.");
  refuse_uneven_rows(file, blocks, header);
  std::size_t last = blocks.size();  // the last block with a whole frame
  for (std::size_t i = 0; i < blocks.size(); ++i)
    if (blocks[i].width == width && blocks[i].rows >= header.height) last = i;
  std::vector<Place> frames;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto& block = blocks[i];
    if (block.width == width &&
        (options.frame_rows ? block.rows >= header.height : block.rows == header.height)) {
      for (std::size_t row = 0; row + header.height <= block.rows; row += header.height)
        frames.push_back({block.place, row});
      if (block.rows % header.height != 0) ++header.frames_lost;
      continue;
    }
    if (last == blocks.size() || i > last) {  // begun behind the last whole frame
      header.frames_lost = std::max<std::size_t>(header.frames_lost, 1);
    } else if (block.width == width) {
      throw InputError(fmt::format(
          "{}: the {} rows from line {} on are not as many as the {} of the other frames; repair "
          "the line that interrupts them, or say how many rows a frame has.",
          file.path().string(), block.rows, block.line, header.height));
    }
  }
  return frames;
}

/// The rows of every frame, as they stand in the file.
struct Rows {
  ByteFile file;
  CsvDialect dialect;
  std::vector<Place> frames;
  std::size_t width = 0, height = 0;

  void read(std::size_t index, std::vector<float>& into) const {
    LineReader reader(file, frames[index].place);
    std::string_view line;
    std::vector<float> values;
    into.resize(width * height);
    for (std::size_t row = 0; row < frames[index].first; ++row) reader.next(line);
    for (std::size_t row = 0; row < height; ++row) {
      if (!reader.next(line) || !parse_csv_row(line, dialect, values) || values.size() != width)
        throw InputError(fmt::format(
            "{}: row {} of frame {} is no row of {} numbers any more; the file was changed "
            "while it was read.",
            file.path().string(), row, index, width));
      std::copy(values.begin(), values.end(),
                into.begin() + static_cast<std::ptrdiff_t>(row * width));
    }
  }
};

/// The numbers of rows and columns that the first frame and the last bring along; the header then
/// has the size that is left.
CsvNumbers find_numbers(const Rows& rows, RecordingHeader& header) {
  if (rows.frames.empty()) return {};
  check_frame_size(header);
  std::vector<float> values;
  rows.read(0, values);
  const CsvNumbers numbers = csv_numbers(values, rows.width, rows.height);
  if (!numbers.row && !numbers.column) return {};
  rows.read(rows.frames.size() - 1, values);
  if (csv_numbers(values, rows.width, rows.height) != numbers) return {};
  header.height -= numbers.row ? 1 : 0;
  header.width -= numbers.column ? 1 : 0;
  header.notes.push_back(
      fmt::format("The first {} of every frame counts 0, 1, 2, ... and was left out.",
                  numbers.row && numbers.column ? "row and the first column"
                  : numbers.row                 ? "row"
                                                : "column"));
  return numbers;
}

}  // namespace

bool is_csv(std::string_view first_bytes) {
  if (is_utf16(first_bytes)) return is_csv(as_bytes(first_bytes));
  const bool text = std::all_of(first_bytes.begin(), first_bytes.end(), [](unsigned char c) {
    return c == '\n' || c == '\r' || c == '\t' || c >= 0x20;
  });
  CsvDialect dialect;
  return text && detect_csv_dialect(whole_values(first_bytes), {}, dialect);
}

Recording open_csv(const std::filesystem::path& path, const ReadOptions& options) {
  const ByteFile file = open_text(path);
  CsvDialect dialect;
  const std::string beginning = file.beginning(sample_size);
  const std::string_view sample = whole_values(beginning);
  if (!detect_csv_dialect(sample, options, dialect))
    throw InputError(
        path.string() +
        ": there is no row of numbers in the text; say which separator and decimal sign it has.");
  check_csv_commas(path, sample, dialect, options);
  RecordingHeader header;
  header.path = path;
  std::string preamble;
  const auto blocks = find_csv_blocks(file, dialect, options.preamble_lines.value_or(0), preamble);
  const auto frames = frames_of(file, blocks, options, header);
  header.frames = frames.size();
  header.notes.push_back("A text holds no times: frame rate and integration time are unknown.");
  const SignalScale scale = describe_signal(csv_unit(preamble), options.unit, header);
  const Rows rows{file, dialect, frames, header.width, header.height};
  const CsvNumbers numbers = find_numbers(rows, header);
  return {header, [rows, scale, numbers](std::size_t index, Frame& frame) {
            std::vector<float> values;
            rows.read(index, values);
            without_numbers(values, rows.width, numbers, frame.values);
            scale.apply(frame.values);
          }};
}

}  // namespace meltproof::imaging

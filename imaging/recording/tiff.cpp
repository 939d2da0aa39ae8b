// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/tiff.hpp"

#include <algorithm>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <tiffio.h>

#include "base/error.hpp"
#include "imaging/recording/bytes.hpp"

namespace meltproof::imaging {
namespace {

// More than this no compression gains, so a damaged size is told before memory is asked for.
constexpr std::uint64_t most_gain = 20000, smallest_part = 1 << 16;

/// How the pixels of a page are stored.
struct Layout {
  std::uint32_t width = 0, height = 0;
  std::uint16_t bits = 0, format = SAMPLEFORMAT_UINT;
  bool operator==(const Layout&) const = default;
};

struct Tiff {
  std::shared_ptr<TIFF> handle;
  std::shared_ptr<std::string> last_error = std::make_shared<std::string>();
};

int remember(TIFF*, void* text, const char*, const char* format, va_list arguments) {
  char line[256];
  if (std::vsnprintf(line, sizeof line, format, arguments) > 0)
    *static_cast<std::string*>(text) = line;
  return 1;  // handled: libtiff prints nothing itself
}

Tiff open_handle(const std::filesystem::path& path, std::uint64_t file_size) {
  Tiff tiff;
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(
      TIFFOpenOptionsAlloc(), &TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), remember, tiff.last_error.get());
  TIFFOpenOptionsSetWarningHandlerExtR(
      options.get(), [](TIFF*, void*, const char*, const char*, va_list) { return 1; }, nullptr);
  // libtiff itself believes what a damaged directory says of its own length.
  TIFFOpenOptionsSetMaxSingleMemAlloc(
      options.get(), static_cast<tmsize_t>(std::min<std::uint64_t>(
                         most_gain * file_size + smallest_part, std::uint64_t{4} << 30)));
  TIFF* handle = TIFFOpenExt(path.c_str(), "r", options.get());
  if (!handle)
    throw InputError(path.string() + ": the TIFF cannot be opened (" + *tiff.last_error +
                     "); it is damaged or cut off before its directory.");
  // The text that errors go to must live as long as the handle, so the handle owns it.
  tiff.handle = std::shared_ptr<TIFF>(handle, [keep = tiff.last_error](TIFF* t) { TIFFClose(t); });
  return tiff;
}

Layout layout_of(TIFF* t, const std::filesystem::path& path, std::size_t page) {
  Layout layout;
  std::uint16_t samples = 1;
  TIFFGetField(t, TIFFTAG_IMAGEWIDTH, &layout.width);
  TIFFGetField(t, TIFFTAG_IMAGELENGTH, &layout.height);
  TIFFGetFieldDefaulted(t, TIFFTAG_BITSPERSAMPLE, &layout.bits);
  TIFFGetFieldDefaulted(t, TIFFTAG_SAMPLEFORMAT, &layout.format);
  TIFFGetFieldDefaulted(t, TIFFTAG_SAMPLESPERPIXEL, &samples);
  const bool integer = (layout.format == SAMPLEFORMAT_UINT || layout.format == SAMPLEFORMAT_INT) &&
                       (layout.bits == 8 || layout.bits == 16 || layout.bits == 32);
  const bool real =
      layout.format == SAMPLEFORMAT_IEEEFP && (layout.bits == 32 || layout.bits == 64);
  if (samples != 1 || !(integer || real))
    throw InputError(path.string() + ": page " + std::to_string(page) + " has " +
                     std::to_string(samples) + " channels of " + std::to_string(layout.bits) +
                     " bits; expected one channel of 8, 16 or 32 bits or of floating point.");
  return layout;
}

/// Whether all the data that the page points to lie within the file.
bool is_whole(TIFF* t, std::uint64_t file_size) {
  const bool tiled = TIFFIsTiled(t) != 0;
  std::uint64_t* places = nullptr;
  std::uint64_t* lengths = nullptr;
  TIFFGetField(t, tiled ? TIFFTAG_TILEOFFSETS : TIFFTAG_STRIPOFFSETS, &places);
  TIFFGetField(t, tiled ? TIFFTAG_TILEBYTECOUNTS : TIFFTAG_STRIPBYTECOUNTS, &lengths);
  const std::uint32_t parts = tiled ? TIFFNumberOfTiles(t) : TIFFNumberOfStrips(t);
  if (!places || !lengths) return false;
  for (std::uint32_t i = 0; i < parts; ++i)
    if (places[i] > file_size || lengths[i] > file_size - places[i]) return false;
  return true;
}

/// Bytes of a strip or tile in memory. @throws InputError if the file cannot hold as much, or if
/// rows of it have no length.
std::size_t part_size(TIFF* t, const std::filesystem::path& path, std::size_t page,
                      std::uint64_t file_size) {
  const bool tiled = TIFFIsTiled(t) != 0;
  std::uint32_t rows = 1, columns = 1;
  TIFFGetFieldDefaulted(t, tiled ? TIFFTAG_TILELENGTH : TIFFTAG_ROWSPERSTRIP, &rows);
  if (tiled) TIFFGetField(t, TIFFTAG_TILEWIDTH, &columns);
  const tmsize_t size = tiled ? TIFFTileSize(t) : TIFFStripSize(t);
  const auto bytes = static_cast<std::uint64_t>(std::max<tmsize_t>(0, size));
  if (bytes == 0 || rows == 0 || columns == 0 || bytes > most_gain * file_size + smallest_part)
    throw InputError(path.string() + ": frame " + std::to_string(page) + " comes in parts of " +
                     std::to_string(rows) + " rows and " + std::to_string(bytes) +
                     " bytes, which the file cannot hold; it is damaged.");
  return static_cast<std::size_t>(bytes);
}

void convert(const char* raw, std::size_t count, const Layout& layout, float* into) {
  const auto as = [&]<class T>(T) {
    for (std::size_t i = 0; i < count; ++i) {
      T value;
      std::memcpy(&value, raw + i * sizeof(T), sizeof(T));
      into[i] = static_cast<float>(value);
    }
  };
  const bool is_signed = layout.format == SAMPLEFORMAT_INT;
  if (layout.format == SAMPLEFORMAT_IEEEFP) return layout.bits == 32 ? as(float{}) : as(double{});
  if (layout.bits == 8) return is_signed ? as(std::int8_t{}) : as(std::uint8_t{});
  if (layout.bits == 16) return is_signed ? as(std::int16_t{}) : as(std::uint16_t{});
  return is_signed ? as(std::int32_t{}) : as(std::uint32_t{});
}

void read_page(const Tiff& tiff, const ByteFile& file, const Layout& layout, Frame& frame) {
  TIFF* t = tiff.handle.get();
  const auto failed = [&] {
    throw InputError(file.path().string() + ": frame " + std::to_string(frame.index) +
                     " cannot be decoded (" + *tiff.last_error + "); the file is damaged.");
  };
  std::vector<char> part(part_size(t, file.path(), frame.index, file.size()));
  if (!TIFFIsTiled(t)) {
    std::uint32_t rows_per_strip = layout.height;
    TIFFGetFieldDefaulted(t, TIFFTAG_ROWSPERSTRIP, &rows_per_strip);
    rows_per_strip = std::min(rows_per_strip, layout.height);
    for (std::uint32_t row = 0; row < layout.height; row += rows_per_strip) {
      const std::size_t rows = std::min(rows_per_strip, layout.height - row);
      const std::size_t wanted = rows * layout.width * layout.bits / 8;
      if (wanted > part.size()) failed();  // libtiff means another layout than these tags
      const auto got = TIFFReadEncodedStrip(t, TIFFComputeStrip(t, row, 0), part.data(),
                                            static_cast<tmsize_t>(wanted));
      if (got < 0 || static_cast<std::size_t>(got) != wanted) failed();
      convert(part.data(), rows * layout.width, layout,
              frame.values.data() + std::size_t{row} * layout.width);
    }
    return;
  }
  std::uint32_t tile_width = 0, tile_height = 0;
  TIFFGetField(t, TIFFTAG_TILEWIDTH, &tile_width);
  TIFFGetField(t, TIFFTAG_TILELENGTH, &tile_height);
  const std::size_t row_bytes = static_cast<std::size_t>(TIFFTileRowSize(t));
  if (row_bytes * tile_height > part.size() ||
      std::size_t{tile_width} * layout.bits / 8 > row_bytes)
    failed();
  for (std::uint32_t y = 0; y < layout.height; y += tile_height)
    for (std::uint32_t x = 0; x < layout.width; x += tile_width) {
      if (TIFFReadTile(t, part.data(), x, y, 0, 0) < 0) failed();
      const std::size_t columns = std::min(tile_width, layout.width - x);
      for (std::uint32_t row = 0; row < std::min(tile_height, layout.height - y); ++row)
        convert(part.data() + row * row_bytes, columns, layout,
                frame.values.data() + std::size_t{y + row} * layout.width + x);
    }
}

}  // namespace

bool is_tiff(std::string_view first_bytes) {
  using namespace std::string_view_literals;
  for (const auto mark : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv})  // + is BigTIFF
    if (first_bytes.starts_with(mark)) return true;
  return false;
}

Recording open_tiff(const std::filesystem::path& path) {
  const ByteFile file(path);
  const Tiff tiff = open_handle(path, file.size());
  TIFF* t = tiff.handle.get();
  RecordingHeader header;
  header.path = path;
  std::vector<std::uint64_t>
      places;  // of the directories: a page is then reached at once, not by counting
  std::optional<Layout> layout;
  for (std::size_t page = 0;; ++page) {
    std::uint32_t kind = 0;
    TIFFGetFieldDefaulted(t, TIFFTAG_SUBFILETYPE, &kind);
    if (!(kind & FILETYPE_REDUCEDIMAGE)) {  // previews are no frames
      const Layout here = layout_of(t, path, page);
      if (!layout) layout = here;
      if (here != *layout)
        throw InputError(path.string() + ": page " + std::to_string(page) + " is " +
                         std::to_string(here.width) + " x " + std::to_string(here.height) +
                         " pixels of " + std::to_string(here.bits) + " bits, but the first is " +
                         std::to_string(layout->width) + " x " + std::to_string(layout->height) +
                         " of " + std::to_string(layout->bits) +
                         "; the frames of a recording are alike.");
      if (is_whole(t, file.size()))
        places.push_back(TIFFCurrentDirOffset(t));
      else
        ++header.frames_lost;
    }
    if (TIFFLastDirectory(t)) break;
    if (!TIFFReadDirectory(t)) {  // the chain of pages is cut off: at least one more was announced
      ++header.frames_lost;
      break;
    }
  }
  if (layout) {
    header.width = layout->width;
    header.height = layout->height;
    check_frame_size(header);
    if (std::uint64_t{layout->width} * layout->height * layout->bits / 8 >
        most_gain * file.size() + smallest_part)
      throw InputError(path.string() + ": the pages are said to have " +
                       std::to_string(layout->width) + " x " + std::to_string(layout->height) +
                       " pixels, which the file cannot hold; it is damaged.");
    if (layout->format == SAMPLEFORMAT_UINT) {
      header.saturation = static_cast<double>((std::uint64_t{1} << layout->bits) - 1);
      header.under_range = 0;
    }
  }
  header.frames = places.size();
  header.notes.push_back(
      "TIFF stores no times: frame rate and integration time are unknown unless they are given.");
  return {header, [tiff, file, path, places, layout](std::size_t index, Frame& frame) {
            if (!TIFFSetSubDirectory(tiff.handle.get(), places[index]))
              throw InputError(path.string() + ": page " + std::to_string(index) +
                               " cannot be reached (" + *tiff.last_error +
                               "); the file is damaged.");
            read_page(tiff, file, *layout, frame);
          }};
}

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/tiff_pixels.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "base/error.hpp"

namespace meltproof::imaging {
namespace {

// More than this no compression gains, so a damaged size is told before memory is asked for.
constexpr std::uint64_t most_gain = 20000, smallest_part = 1 << 16;

int remember(TIFF*, void* text, const char*, const char* format, va_list arguments) {
  char line[256];
  if (std::vsnprintf(line, sizeof line, format, arguments) > 0)
    *static_cast<std::string*>(text) = line;
  return 1;  // handled: libtiff prints nothing itself
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
  if (bytes == 0 || rows == 0 || columns == 0 || !tiff_can_hold(bytes, file_size))
    throw InputError(path.string() + ": frame " + std::to_string(page) + " comes in parts of " +
                     std::to_string(rows) + " rows and " + std::to_string(bytes) +
                     " bytes, which the file cannot hold; it is damaged.");
  return static_cast<std::size_t>(bytes);
}

/// Samples of 9 to 15 bits, the first bit the highest, one behind the other.
void unpack(const char* raw, std::size_t count, unsigned bits, float* into) {
  std::uint32_t held = 0;
  unsigned fill = 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (; fill < bits; fill += 8) held = held << 8 | static_cast<unsigned char>(*raw++);
    fill -= bits;
    into[i] = static_cast<float>(held >> fill & ((1U << bits) - 1));
  }
}

}  // namespace

bool tiff_can_hold(std::uint64_t bytes, std::uint64_t file_size) {
  return bytes <= most_gain * file_size + smallest_part;
}

TiffHandle open_tiff_handle(const std::filesystem::path& path, std::uint64_t file_size) {
  TiffHandle tiff{nullptr, std::make_shared<std::string>()};
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
  tiff.tiff = std::shared_ptr<TIFF>(handle, [keep = tiff.last_error](TIFF* t) { TIFFClose(t); });
  return tiff;
}

std::optional<TiffLayout> tiff_layout(TIFF* t, const std::filesystem::path& path,
                                      std::size_t page) {
  TiffLayout layout;
  std::uint16_t samples = 1, colours = PHOTOMETRIC_MINISBLACK;
  TIFFGetField(t, TIFFTAG_IMAGEWIDTH, &layout.width);
  TIFFGetField(t, TIFFTAG_IMAGELENGTH, &layout.height);
  TIFFGetFieldDefaulted(t, TIFFTAG_BITSPERSAMPLE, &layout.bits);
  TIFFGetFieldDefaulted(t, TIFFTAG_SAMPLEFORMAT, &layout.format);
  TIFFGetFieldDefaulted(t, TIFFTAG_SAMPLESPERPIXEL, &samples);
  TIFFGetField(t, TIFFTAG_PHOTOMETRIC, &colours);
  if (samples != 1 || colours == PHOTOMETRIC_PALETTE) return std::nullopt;
  if (layout.format == SAMPLEFORMAT_VOID) layout.format = SAMPLEFORMAT_UINT;
  const bool whole = layout.bits == 8 || layout.bits == 16 || layout.bits == 32;
  const bool integer = (layout.format == SAMPLEFORMAT_UINT || layout.format == SAMPLEFORMAT_INT) &&
                       (whole || layout.bits == 64);
  const bool packed = layout.format == SAMPLEFORMAT_UINT && layout.bits > 8 && layout.bits < 16;
  const bool real =
      layout.format == SAMPLEFORMAT_IEEEFP && (layout.bits == 32 || layout.bits == 64);
  if (!(integer || packed || real))
    throw InputError(path.string() + ": the samples of page " + std::to_string(page) + " have " +
                     std::to_string(layout.bits) + " bits (format " +
                     std::to_string(layout.format) +
                     "); expected 8 to 16, 32 or 64 bits or floating point of 32 or 64.");
  layout.white_is_zero =
      colours == PHOTOMETRIC_MINISWHITE && layout.format == SAMPLEFORMAT_UINT && layout.bits <= 16;
  return layout;
}

void convert_tiff_row(const char* raw, std::size_t count, const TiffLayout& layout, float* into) {
  const auto as = [&]<class T>(T) {
    for (std::size_t i = 0; i < count; ++i) {
      T value;
      std::memcpy(&value, raw + i * sizeof(T), sizeof(T));
      into[i] = static_cast<float>(value);
    }
  };
  const bool is_signed = layout.format == SAMPLEFORMAT_INT;
  if (layout.format == SAMPLEFORMAT_IEEEFP)
    layout.bits == 32 ? as(float{}) : as(double{});
  else if (layout.bits == 8)
    is_signed ? as(std::int8_t{}) : as(std::uint8_t{});
  else if (layout.bits == 16)
    is_signed ? as(std::int16_t{}) : as(std::uint16_t{});
  else if (layout.bits == 32)
    is_signed ? as(std::int32_t{}) : as(std::uint32_t{});
  else if (layout.bits == 64)
    is_signed ? as(std::int64_t{}) : as(std::uint64_t{});
  else
    unpack(raw, count, layout.bits, into);
  if (layout.white_is_zero) {
    const float highest = std::ldexp(1.F, layout.bits) - 1;
    for (std::size_t i = 0; i < count; ++i) into[i] = highest - into[i];
  }
}

void read_tiff_page(const TiffHandle& tiff, const std::filesystem::path& path,
                    std::uint64_t file_size, const TiffLayout& layout, Frame& frame) {
  TIFF* t = tiff.tiff.get();
  const auto failed = [&] {
    throw InputError(path.string() + ": frame " + std::to_string(frame.index) +
                     " cannot be decoded (" + *tiff.last_error + "); the file is damaged.");
  };
  std::vector<char> part(part_size(t, path, frame.index, file_size));
  if (!TIFFIsTiled(t)) {
    std::uint32_t rows_per_strip = layout.height;
    TIFFGetFieldDefaulted(t, TIFFTAG_ROWSPERSTRIP, &rows_per_strip);
    rows_per_strip = std::min(rows_per_strip, layout.height);
    const std::size_t row_bytes = layout.row_bytes(layout.width);
    for (std::uint32_t row = 0; row < layout.height; row += rows_per_strip) {
      const std::size_t rows = std::min(rows_per_strip, layout.height - row);
      const std::size_t wanted = rows * row_bytes;
      if (wanted > part.size()) failed();  // libtiff means another layout than these tags
      const auto got = TIFFReadEncodedStrip(t, TIFFComputeStrip(t, row, 0), part.data(),
                                            static_cast<tmsize_t>(wanted));
      if (got < 0 || static_cast<std::size_t>(got) != wanted) failed();
      for (std::size_t i = 0; i < rows; ++i)
        convert_tiff_row(part.data() + i * row_bytes, layout.width, layout,
                         frame.values.data() + (row + i) * layout.width);
    }
    return;
  }
  std::uint32_t tile_width = 0, tile_height = 0;
  TIFFGetField(t, TIFFTAG_TILEWIDTH, &tile_width);
  TIFFGetField(t, TIFFTAG_TILELENGTH, &tile_height);
  const std::size_t row_bytes = static_cast<std::size_t>(TIFFTileRowSize(t));
  if (row_bytes * tile_height > part.size() || layout.row_bytes(tile_width) > row_bytes) failed();
  for (std::uint32_t y = 0; y < layout.height; y += tile_height)
    for (std::uint32_t x = 0; x < layout.width; x += tile_width) {
      if (TIFFReadTile(t, part.data(), x, y, 0, 0) < 0) failed();
      const std::size_t columns = std::min(tile_width, layout.width - x);
      for (std::uint32_t row = 0; row < std::min(tile_height, layout.height - y); ++row)
        convert_tiff_row(part.data() + row * row_bytes, columns, layout,
                         frame.values.data() + std::size_t{y + row} * layout.width + x);
    }
}

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/tiff_layer.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>

#include <fmt/format.h>
#include <tiffio.h>

#include "base/error.hpp"

namespace meltproof::validation {
namespace {

constexpr std::uint64_t most_pixels = std::uint64_t{1} << 26;
// More than this no compression of TIFF gains: a larger claim comes from a damaged directory.
constexpr std::uint64_t most_gain = 2000;

struct Kind {
  std::uint16_t bits = 8, format = SAMPLEFORMAT_UINT, samples = 1;
};

double number(const std::uint8_t* at, const Kind& kind) {
  const auto as = [at]<class T>(T value) {
    std::memcpy(&value, at, sizeof value);
    return static_cast<double>(value);
  };
  if (kind.format == SAMPLEFORMAT_IEEEFP) {
    return kind.bits == 32 ? as(float{}) : as(double{});
  }
  const bool is_signed = kind.format == SAMPLEFORMAT_INT;
  switch (kind.bits) {
    case 8:
      return is_signed ? as(std::int8_t{}) : as(std::uint8_t{});
    case 16:
      return is_signed ? as(std::int16_t{}) : as(std::uint16_t{});
    default:
      return is_signed ? as(std::int32_t{}) : as(std::uint32_t{});
  }
}

int keep_quiet(TIFF*, void*, const char*, const char*, va_list) { return 1; }

}  // namespace

bool is_tiff(std::string_view first_bytes) {
  using namespace std::string_view_literals;
  for (const auto mark : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv}) {
    if (first_bytes.starts_with(mark)) {
      return true;
    }
  }
  return false;
}

Layer read_tiff_layer(const std::filesystem::path& path) {
  const std::string place = path.string();
  const auto damaged = [&place](const std::string& what) {
    return InputError(
        fmt::format("{}: the TIFF is damaged or cut off ({}): export the map again.", place, what));
  };
  if (!std::filesystem::is_regular_file(path)) {
    throw InputError(fmt::format("{}: there is no such file.", place));
  }
  const std::uint64_t file_size = std::filesystem::file_size(path);
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(
      TIFFOpenOptionsAlloc(), &TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_quiet, nullptr);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), keep_quiet, nullptr);
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(),
                                      static_cast<tmsize_t>(most_gain * file_size + (1 << 20)));
  const std::unique_ptr<TIFF, decltype(&TIFFClose)> tiff(
      TIFFOpenExt(path.c_str(), "r", options.get()), &TIFFClose);
  if (!tiff) {
    throw damaged("it cannot be opened");
  }
  std::uint32_t width = 0, height = 0;
  Kind kind;
  TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &height);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_BITSPERSAMPLE, &kind.bits);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_SAMPLEFORMAT, &kind.format);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, &kind.samples);
  const bool integer = kind.format != SAMPLEFORMAT_IEEEFP;
  const bool known = integer ? kind.bits == 8 || kind.bits == 16 || kind.bits == 32
                             : kind.bits == 32 || kind.bits == 64;
  if (kind.samples != 1 || !known) {
    throw InputError(fmt::format(
        "{}: it has {} channels of {} bits: expected one channel of numbers (8, 16 or 32 bit "
        "integers or floating point), not a coloured picture of the map.",
        place, kind.samples, kind.bits));
  }
  const std::uint64_t pixels = std::uint64_t{width} * height, bytes = kind.bits / 8u;
  if (pixels == 0 || pixels > most_pixels || pixels * bytes > most_gain * file_size) {
    throw damaged(fmt::format("{} x {} pixels in {} bytes", width, height, file_size));
  }
  Layer layer{width, height, std::vector<double>(pixels), integer};
  const bool tiled = TIFFIsTiled(tiff.get()) != 0;
  std::uint32_t part_width = width, part_height = height;
  if (tiled) {
    TIFFGetField(tiff.get(), TIFFTAG_TILEWIDTH, &part_width);
    TIFFGetField(tiff.get(), TIFFTAG_TILELENGTH, &part_height);
  } else {
    TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_ROWSPERSTRIP, &part_height);
    part_height = std::min(part_height, height);
  }
  const tmsize_t size = tiled ? TIFFTileSize(tiff.get()) : TIFFStripSize(tiff.get());
  const std::uint64_t expected = std::uint64_t{part_width} * part_height * bytes;
  if (size <= 0 || part_width == 0 || part_height == 0 ||
      static_cast<std::uint64_t>(size) != expected ||
      expected > most_gain * file_size + (1 << 20)) {
    throw damaged("its parts do not fit its size");
  }
  std::vector<std::uint8_t> part(expected);
  for (std::uint32_t y = 0; y < height; y += part_height) {
    for (std::uint32_t x = 0; x < width; x += part_width) {
      const std::uint32_t rows = std::min(part_height, height - y);
      const std::uint32_t columns = std::min(part_width, width - x);
      const auto wanted =
          static_cast<tmsize_t>(tiled ? expected : std::uint64_t{rows} * part_width * bytes);
      const tmsize_t got =
          tiled ? TIFFReadEncodedTile(tiff.get(), TIFFComputeTile(tiff.get(), x, y, 0, 0),
                                      part.data(), wanted)
                : TIFFReadEncodedStrip(tiff.get(), TIFFComputeStrip(tiff.get(), y, 0), part.data(),
                                       wanted);
      if (got != wanted) {
        throw damaged(fmt::format("rows from {} on cannot be decoded", y));
      }
      for (std::uint32_t row = 0; row < rows; ++row) {
        for (std::uint32_t column = 0; column < columns; ++column) {
          layer.values[std::size_t{y + row} * width + x + column] =
              number(part.data() + (std::size_t{row} * part_width + column) * bytes, kind);
        }
      }
    }
  }
  return layer;
}

}  // namespace meltproof::validation

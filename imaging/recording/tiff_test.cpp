// SPDX-License-Identifier: GPL-3.0-or-later
// Synthetic TIFF stacks of every layout that cameras' software exports, written with libtiff.
#include "imaging/recording/tiff.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tiffio.h>

#include "base/atomic_file.hpp"
#include "base/error.hpp"

namespace meltproof::imaging {
namespace {

namespace fs = std::filesystem;

struct Stack {
  const char* mode = "w";  // "w8": BigTIFF, "wb": big endian
  std::uint16_t bits = 16, format = SAMPLEFORMAT_UINT, compression = COMPRESSION_NONE;
  bool tiled = false;
  std::uint32_t width = 5, height = 4;
};

/// Pixel i of page p holds 10 p + i; T is the stored type.
template <class T>
fs::path write_stack(const std::string& name, const Stack& s, std::size_t pages) {
  const fs::path path =
      fs::temp_directory_path() / fmt::format("meltproof-{}-{}", ::getpid(), name);
  const std::unique_ptr<TIFF, decltype(&TIFFClose)> t(TIFFOpen(path.c_str(), s.mode), &TIFFClose);
  for (std::size_t page = 0; page < pages; ++page) {
    TIFFSetField(t.get(), TIFFTAG_IMAGEWIDTH, s.width);
    TIFFSetField(t.get(), TIFFTAG_IMAGELENGTH, s.height);
    TIFFSetField(t.get(), TIFFTAG_BITSPERSAMPLE, static_cast<int>(s.bits));
    TIFFSetField(t.get(), TIFFTAG_SAMPLEFORMAT, static_cast<int>(s.format));
    TIFFSetField(t.get(), TIFFTAG_SAMPLESPERPIXEL, 1);
    TIFFSetField(t.get(), TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(t.get(), TIFFTAG_COMPRESSION, static_cast<int>(s.compression));
    const auto value = [&](std::uint32_t x, std::uint32_t y) {
      return static_cast<T>(10 * static_cast<double>(page) + y * s.width + x);
    };
    if (s.tiled) {
      TIFFSetField(t.get(), TIFFTAG_TILEWIDTH, 16);
      TIFFSetField(t.get(), TIFFTAG_TILELENGTH, 16);
      for (std::uint32_t y = 0; y < s.height; y += 16)
        for (std::uint32_t x = 0; x < s.width; x += 16) {
          std::vector<T> tile(256);
          for (std::uint32_t i = 0; i < 256; ++i) tile[i] = value(x + i % 16, y + i / 16);
          TIFFWriteTile(t.get(), tile.data(), x, y, 0, 0);
        }
    } else {
      TIFFSetField(t.get(), TIFFTAG_ROWSPERSTRIP, 3);  // does not divide the height
      for (std::uint32_t y = 0; y < s.height; ++y) {
        std::vector<T> row(s.width);
        for (std::uint32_t x = 0; x < s.width; ++x) row[x] = value(x, y);
        TIFFWriteScanline(t.get(), row.data(), y, 0);
      }
    }
    TIFFWriteDirectory(t.get());
  }
  return path;
}

void expect_stack(const fs::path& path, const Stack& s, std::size_t pages) {
  const auto recording = open_tiff(path);
  ASSERT_EQ(recording.header().frames, pages);
  ASSERT_EQ(recording.header().width, s.width);
  ASSERT_EQ(recording.header().height, s.height);
  EXPECT_EQ(recording.header().frames_lost, 0u);
  for (std::size_t page = pages; page-- > 0;) {  // backwards: any page is reached at once
    const auto f = recording.frame(page);
    for (std::size_t i = 0; i < f.values.size(); ++i)
      ASSERT_EQ(f.values[i], static_cast<float>(10 * page + i))
          << "page " << page << " pixel " << i;
  }
  fs::remove(path);
}

TEST(Tiff, ReadsEveryTypeOfNumber) {
  const Stack u8{.bits = 8}, u16{}, i16{.bits = 16, .format = SAMPLEFORMAT_INT}, u32{.bits = 32};
  const Stack f32{.bits = 32, .format = SAMPLEFORMAT_IEEEFP},
      f64{.bits = 64, .format = SAMPLEFORMAT_IEEEFP};
  expect_stack(write_stack<std::uint8_t>("u8.tif", u8, 3), u8, 3);
  expect_stack(write_stack<std::uint16_t>("u16.tif", u16, 3), u16, 3);
  expect_stack(write_stack<std::int16_t>("i16.tif", i16, 3), i16, 3);
  expect_stack(write_stack<std::uint32_t>("u32.tif", u32, 3), u32, 3);
  expect_stack(write_stack<float>("f32.tif", f32, 3), f32, 3);
  expect_stack(write_stack<double>("f64.tif", f64, 3), f64, 3);
}

TEST(Tiff, ReadsBigEndianBigTiffTilesAndCompression) {
  const Stack big_endian{.mode = "wb"}, big_tiff{.mode = "w8"}, lzw{.compression = COMPRESSION_LZW};
  const Stack tiles{.tiled = true, .width = 37, .height = 21};
  expect_stack(write_stack<std::uint16_t>("be.tif", big_endian, 3), big_endian, 3);
  expect_stack(write_stack<std::uint16_t>("big.tif", big_tiff, 3), big_tiff, 3);
  expect_stack(write_stack<std::uint16_t>("lzw.tif", lzw, 3), lzw, 3);
  expect_stack(write_stack<std::uint16_t>("tiles.tif", tiles, 2), tiles, 2);
}

TEST(Tiff, ReadsMorePagesThanSixteenBitsCount) {
  for (const char* mode : {"w", "w8"}) {  // classic and BigTIFF
    const Stack s{.mode = mode, .bits = 32, .width = 2, .height = 1};
    const auto path = write_stack<std::uint32_t>("many.tif", s, 65600);
    const auto recording = open_tiff(path);
    ASSERT_EQ(recording.header().frames, 65600u);
    EXPECT_EQ(recording.frame(65599).values[1], 655991);
    EXPECT_EQ(recording.frame(3).values[1], 31);
    fs::remove(path);
  }
}

TEST(Tiff, KeepsTheWholePagesOfATruncatedStack) {
  const Stack s{};
  const auto path = write_stack<std::uint16_t>("cut.tif", s, 5);
  const std::string whole = read_file(path);
  // libtiff writes a page's pixels before its directory: the cut takes the last directory's end.
  write_file(path, whole.substr(0, whole.size() - 5));
  const auto recording = open_tiff(path);
  EXPECT_EQ(recording.header().frames, 4u);
  EXPECT_EQ(recording.header().frames_lost, 1u);
  EXPECT_EQ(recording.frame(3).values[7], 37);
  write_file(path, whole.substr(0, 30));
  EXPECT_THROW(open_tiff(path), InputError);
  fs::remove(path);
}

TEST(Tiff, RefusesColour) {
  const fs::path path = fs::temp_directory_path() / fmt::format("meltproof-{}-rgb.tif", ::getpid());
  {
    const std::unique_ptr<TIFF, decltype(&TIFFClose)> t(TIFFOpen(path.c_str(), "w"), &TIFFClose);
    TIFFSetField(t.get(), TIFFTAG_IMAGEWIDTH, 2);
    TIFFSetField(t.get(), TIFFTAG_IMAGELENGTH, 1);
    TIFFSetField(t.get(), TIFFTAG_BITSPERSAMPLE, 8);
    TIFFSetField(t.get(), TIFFTAG_SAMPLESPERPIXEL, 3);
    TIFFSetField(t.get(), TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
    TIFFSetField(t.get(), TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    std::vector<unsigned char> row(6);
    TIFFWriteScanline(t.get(), row.data(), 0, 0);
  }
  EXPECT_THROW(open_tiff(path), InputError);
  fs::remove(path);
}

}  // namespace
}  // namespace meltproof::imaging

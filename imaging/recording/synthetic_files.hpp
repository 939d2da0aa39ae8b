// SPDX-License-Identifier: GPL-3.0-or-later
// Synthetic files of formats of which no real one is at hand, written from their public layouts and
// without any code of the readers: for tests, and as seeds for fuzzing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace meltproof::imaging::synthetic {

/// One picture of counts, row-major.
struct Picture {
  std::size_t width = 0, height = 0;
  std::vector<std::uint16_t> counts;
};

/// A smooth scene with a bright spot that moves with `frame` and some noise in the low bits, counts
/// 17000 to 20000: what a FLIR camera gives of a warm object.
Picture scene(std::size_t width, std::size_t height, std::size_t frame);

/// How pixels are stored in a FLIR block.
enum class Pixels { raw, png, png_exchanged, jpeg_ls };
struct FlirBlock {
  Pixels pixels = Pixels::raw;
  bool big_header = false;   ///< byte order of header and directory
  bool big_records = false;  ///< byte order of the records
  bool camera = true;        ///< whether there is a record with the calibration
  std::uint32_t seconds = 1339617128, milliseconds = 699;
  std::uint16_t frame_rate = 30;
};
/// A FLIR block with the calibration of a real SC660.
std::string flir_block(const Picture& picture, const FlirBlock& options);
/// A JPEG around a FLIR block, cut into parts of at most `part` bytes.
std::string flir_jpeg(const std::string& block, std::size_t part);

/// A Cedip PTW of 14 bits, 100 Hz.
std::string ptw(const std::vector<Picture>& frames);

/// An SFMOV of the type UInt16 or Flt32 that announces `announced` frames.
std::string sfmov(const std::vector<Picture>& frames, const std::string& type,
                  std::size_t announced);
/// An .inc file with the published coefficients of an SC8200 (3 to 4.9 um, -20 to 55 Celsius).
std::string sfmov_include();

/// An IRB: a sequence as a chain of directories if there is more than one frame. A count is a place
/// in a table that gives 250 K + count / 256 (K), every frame `period` ms after the one before.
std::string irb(const std::vector<Picture>& frames, bool compressed, std::uint32_t period = 20);

/// A MATLAB 5 file with one variable of doubles (single if not `doubles`) values(row, column,
/// frame), and a scalar before it.
std::string mat5(const std::vector<Picture>& frames, bool compressed, bool big_endian = false,
                 bool doubles = true);

/// A classic little-endian TIFF, one page a frame, uncompressed.
std::string tiff(const std::vector<Picture>& frames);
/// An 8-bit BMP and a 16-bit PNG of one picture.
std::string bmp(const Picture& picture);
std::string png(const Picture& picture);

/// An HDF5 file with the data set `name`[frame][row][column], in chunks of one frame if `chunked`.
void write_hdf5(const std::filesystem::path& path, const std::string& name,
                const std::vector<Picture>& frames, bool chunked);
/// A MATLAB 7.3 file: 512 bytes of text, then HDF5 with the variable `frames`(row, column, frame).
void write_matlab_7(const std::filesystem::path& path, const std::vector<Picture>& frames);

/// Rows of numbers with 2 decimals.
std::string csv(const Picture& picture, char separator, char decimal);

}  // namespace meltproof::imaging::synthetic

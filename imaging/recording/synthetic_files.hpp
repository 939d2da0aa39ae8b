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
enum class Pixels { raw, png, png_exchanged, jpeg_ls, jpeg_ls_exchanged };
struct FlirBlock {
  Pixels pixels = Pixels::raw;
  bool big_header = false;            ///< byte order of header and directory
  bool big_records = false;           ///< byte order of the records
  bool camera = true;                 ///< whether there is a record with the calibration
  std::size_t camera_length = 0x466;  ///< bytes of that record: older cameras write less
  std::size_t extra_rows = 0;         ///< rows of zeros behind the pixels
  bool directory_behind = false;      ///< the directory at the end of the block
  std::uint16_t subtype = 0;          ///< of the raw record; 0: what the pixels are
  std::uint32_t seconds = 1339617128, milliseconds = 699;
  std::uint16_t frame_rate = 30;
};
/// A FLIR block with the calibration of a real SC660.
std::string flir_block(const Picture& picture, const FlirBlock& options);
/// A JPEG around a FLIR block, cut into parts of at most `part` bytes.
std::string flir_jpeg(const std::string& block, std::size_t part);

/// A Cedip PTW of 14 bits, 100 Hz. `gap` bytes follow every frame, and then the sizes of frames are
/// counted in bytes.
std::string ptw(const std::vector<Picture>& frames, std::size_t gap = 0);

/// An SFMOV of the type UInt16 or Flt32 that announces `announced` frames.
std::string sfmov(const std::vector<Picture>& frames, const std::string& type,
                  std::size_t announced);
/// An .inc file with the published coefficients of an SC8200 (3 to 4.9 um, -20 to 55 Celsius).
std::string sfmov_include();

/// An IRB: a sequence as a chain of directories if there is more than one frame. A count is a place
/// in a table that gives 250 K + count / 256 (K), every frame `period` ms after the one before.
std::string irb(const std::vector<Picture>& frames, bool compressed, std::uint32_t period = 20);

/// A MATLAB 5 file with one variable of doubles (single if not `doubles`) values(row, column,
/// frame), and a scalar before it. `colour`: values(row, column, 1, frame).
std::string mat5(const std::vector<Picture>& frames, bool compressed, bool big_endian = false,
                 bool doubles = true, bool colour = false);

/// A classic little-endian TIFF, one page a frame, uncompressed.
std::string tiff(const std::vector<Picture>& frames);
/// What ImageJ writes beyond 4 GiB: a big-endian TIFF with one page that announces `announced`
/// images, the other frames behind it.
std::string imagej_stack(const std::vector<Picture>& frames, std::size_t announced);
/// One page with 12-bit samples, packed; `white` if the lowest number is white. Counts are divided
/// by 16 to fit.
std::string tiff_12(const Picture& picture, bool white);
/// An 8-bit BMP and a 16-bit PNG of one picture.
std::string bmp(const Picture& picture);
std::string png(const Picture& picture);

/// A MATLAB 5 file as FLIR's ResearchIR exports one: variables Frame0, Frame1, ..., each with a
/// Frame0_DateTime of seven numbers beside it, in the order of the alphabet.
std::string mat5_frames(const std::vector<Picture>& frames, bool compressed);

/// An HDF5 file with the data set `name`[frame][row][column], in chunks of one frame if `chunked`.
void write_hdf5(const std::filesystem::path& path, const std::string& name,
                const std::vector<Picture>& frames, bool chunked);
/// A MATLAB 7.3 file: 512 bytes of text, then HDF5 with the variable `frames`(row, column, frame).
void write_matlab_7(const std::filesystem::path& path, const std::vector<Picture>& frames);

/// Rows of numbers with 2 decimals.
std::string csv(const Picture& picture, char separator, char decimal);

}  // namespace meltproof::imaging::synthetic

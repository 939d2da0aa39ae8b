// SPDX-License-Identifier: GPL-3.0-or-later
// Synthetic H5OINA and TIFF files for the tests, written with HDF5 and libtiff alone.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>
#include <hdf5.h>
#include <tiffio.h>

namespace meltproof::validation {

/// Writes a synthetic H5OINA from its public specification (version 5.0), with HDF5 alone: nothing
/// of the reader is used.
class SyntheticH5oina {
 public:
  explicit SyntheticH5oina(const std::string& name)
      : path_(std::filesystem::path(testing::TempDir()) / ("synthetic_" + name + ".h5oina")),
        file_(H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)) {
    text("Manufacturer", "synthetic, for a test");
    text("Format Version", "5.0");
    text("Index", "1");
  }
  ~SyntheticH5oina() {
    if (file_ >= 0) {
      H5Fclose(file_);
    }
  }
  void number(const std::string& name, float value) { list(name, {value}, true); }
  void list(const std::string& name, const std::vector<float>& values, bool header = false) {
    const hsize_t dims[2] = {values.size(), 1};
    write("1/EDS/" + std::string(header ? "Header/" : "Data/") + name, H5T_NATIVE_FLOAT,
          H5Screate_simple(2, dims, nullptr), values.data());
  }
  void grid(int columns, int rows, float step) {
    for (const auto& [name, value] : {std::pair{"X Cells", columns}, std::pair{"Y Cells", rows}}) {
      const hsize_t dims[2] = {1, 1};
      write(std::string("1/EDS/Header/") + name, H5T_NATIVE_INT32,
            H5Screate_simple(2, dims, nullptr), &value);
    }
    number("X Step", step);
    number("Y Step", rows == 1 ? 0 : step);
    number("Beam Voltage", 30);
  }
  std::filesystem::path done() {
    H5Fclose(file_);
    file_ = -1;
    return path_;
  }

 private:
  void text(const std::string& name, const std::string& value) {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, value.size() + 1);
    write(name, type, H5Screate(H5S_SCALAR), value.c_str());
    H5Tclose(type);
  }
  void write(const std::string& name, hid_t type, hid_t space, const void* data) {
    const hid_t links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    const hid_t set = H5Dcreate2(file_, name.c_str(), type, space, links, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
    H5Dclose(set);
    H5Sclose(space);
    H5Pclose(links);
  }
  std::filesystem::path path_;
  hid_t file_;
};

/// A TIFF of one channel whose value at column x and row y is value(x, y), in strips or in tiles of
/// 16 pixels.
template <class T>
inline std::filesystem::path synthetic_tiff(const std::string& name, std::uint32_t width,
                                            std::uint32_t height,
                                            const std::function<double(int, int)>& value,
                                            bool tiled = false) {
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / ("synthetic_" + name + ".tif");
  TIFF* tiff = TIFFOpen(path.c_str(), "w");
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8 * sizeof(T));
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT,
               std::is_floating_point_v<T> ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_LZW);
  const std::uint32_t part = tiled ? 16 : 2;
  if (tiled) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, part);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, part);
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, part);
  }
  const std::uint32_t columns = tiled ? part : width;
  for (std::uint32_t y = 0; y < height; y += part) {
    for (std::uint32_t x = 0; x < width; x += columns) {
      std::vector<T> data;
      for (std::uint32_t row = y; row < (tiled ? y + part : std::min(height, y + part)); ++row) {
        for (std::uint32_t column = x; column < x + columns; ++column) {
          data.push_back(static_cast<T>(value(static_cast<int>(column), static_cast<int>(row))));
        }
      }
      const auto size = static_cast<tmsize_t>(data.size() * sizeof(T));
      tiled ? TIFFWriteEncodedTile(tiff, TIFFComputeTile(tiff, x, y, 0, 0), data.data(), size)
            : TIFFWriteEncodedStrip(tiff, TIFFComputeStrip(tiff, y, 0), data.data(), size);
    }
  }
  TIFFClose(tiff);
  return path;
}

}  // namespace meltproof::validation

// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <map>

#include <hdf5.h>
#include <tiffio.h>

#include "validation/eds/concentration.hpp"
#include "validation/eds/eds_test_files.hpp"
#include "validation/eds/element_map.hpp"
#include "validation/eds/formats.hpp"

namespace meltproof::validation {
namespace {

namespace fs = std::filesystem;

/// Writes a synthetic H5OINA from its public specification (version 5.0), with HDF5 alone: nothing
/// of the reader is used.
class SyntheticH5oina {
 public:
  explicit SyntheticH5oina(const std::string& name)
      : path_(fs::path(testing::TempDir()) / ("synthetic_" + name + ".h5oina")),
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
  fs::path done() {
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
  fs::path path_;
  hid_t file_;
};

TEST(H5oina, ALineWithItsUncertaintiesAndCounts) {
  SyntheticH5oina file("line");
  file.grid(3, 1, 0.5f);
  file.list("Composition/Al", {89.65f, 44.825f, 0});
  file.list("Composition/Fe", {10, 55, 100});
  file.list("Composition Sigma/Al", {0.5f, 0.4f, 0.1f});
  file.list("Live Time", {2, 2, 2});
  file.list("Peak Area/Al K series", {1000, 500, 0});
  file.list("Window Integral/Al Ka1", {1100, 600, 50});
  const LineScan line = read_line_scan(file.done());
  EXPECT_EQ(line.format, "H5OINA");
  EXPECT_NEAR(line.position[2], 1e-6, 1e-13);
  EXPECT_FALSE(line.of_atoms);
  EXPECT_EQ(*line.voltage, 30);
  EXPECT_NEAR(line.elements.at("Al").fraction[1], 0.44825, 1e-7);
  EXPECT_NEAR(line.elements.at("Al").uncertainty[2], 0.001, 1e-9);
  EXPECT_TRUE(line.elements.at("Fe").uncertainty.empty());
  EXPECT_NEAR(line.elements.at("Al").counts[0], 2000, 1e-6);
  EXPECT_NEAR(line.elements.at("Al").background[0], 200, 1e-6);
  // sqrt(2000 + 2 x 200) of 2000 counts.
  const auto profile = concentration_from_aluminium(line);
  EXPECT_NEAR(profile.counting[0], std::sqrt(2400.0) / 2000, 1e-7);
}

TEST(H5oina, AMapIsSampledAlongALine) {
  SyntheticH5oina file("map");
  file.grid(4, 3, 1);
  std::vector<float> aluminium, iron;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      aluminium.push_back(static_cast<float>(10 * column + row));
      iron.push_back(100 - aluminium.back());
    }
  }
  file.list("Composition/Al", aluminium);
  file.list("Composition/Fe", iron);
  const fs::path path = file.done();
  EXPECT_REFUSED(read_line_scan(path), "--map-start");
  ScanOptions options;
  options.map_line = ScanOptions::MapLine{{0.5e-6, 0.5e-6}, {2.5e-6, 0.5e-6}, 0};
  const LineScan line = read_line_scan(path, options);
  ASSERT_EQ(line.position.size(), 3u);
  EXPECT_NEAR(line.elements.at("Al").fraction[0], 0.055, 1e-7);  // bilinear: 10 x 0.5 + 0.5
  EXPECT_NEAR(line.elements.at("Al").fraction[2], 0.255, 1e-7);
  EXPECT_TRUE(line.elements.at("Al").uncertainty.empty());  // one sample has no scatter
}

TEST(H5oina, EveryFaultIsASentence) {
  SyntheticH5oina intensities("intensities");
  intensities.grid(2, 1, 1);
  intensities.list("Window Integral/Al Ka1", {1, 2});
  EXPECT_REFUSED(read_line_scan(intensities.done()), "no Composition");
  SyntheticH5oina sizes("sizes");
  sizes.grid(3, 1, 1);
  sizes.list("Composition/Al", {1, 2});
  EXPECT_REFUSED(read_line_scan(sizes.done()), "holds 2 values for 3 x 1 cells");
  SyntheticH5oina cells("cells");
  cells.grid(-3, 1, 1);
  cells.list("Composition/Al", {1, 2});
  EXPECT_REFUSED(read_line_scan(cells.done()), "-3 x 1 cells");
  SyntheticH5oina other("other");
  EXPECT_REFUSED(read_line_scan(other.done()), "without EDS data");
  SyntheticH5oina whole("whole");
  whole.grid(2, 1, 1);
  whole.list("Composition/Al", {1, 2});
  const fs::path path = whole.done();
  fs::resize_file(path, fs::file_size(path) / 2);
  EXPECT_REFUSED(read_line_scan(path), "damaged");
}

/// A TIFF of one channel whose value at column x and row y is value(x, y), in strips or in tiles of
/// 16 pixels.
template <class T>
fs::path synthetic_tiff(const std::string& name, std::uint32_t width, std::uint32_t height,
                        const std::function<double(int, int)>& value, bool tiled = false) {
  const fs::path path = fs::path(testing::TempDir()) / ("synthetic_" + name + ".tif");
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

fs::path description(const std::string& elements) {
  return synthetic_file(
      "map.toml", "unit = \"wt%\"\npixel_size = \"0.5 um\"\nvoltage = \"20 kV\"\n" + elements);
}

TEST(DescribedMap, FloatingPointAndIntegersWithTheirScale) {
  synthetic_tiff<float>(
      "al", 40, 20, [](int x, int) { return 2.0 * x; }, true);
  synthetic_tiff<std::uint16_t>("fe", 40, 20, [](int x, int) { return 10000 - 200 * x; });
  const auto path = description(
      "[[element]]\nsymbol = \"Al\"\nfile = \"synthetic_al.tif\"\n"
      "[[element]]\nsymbol = \"Fe\"\nfile = \"synthetic_fe.tif\"\npercent_per_count = 0.01\n");
  ScanOptions options;
  options.map_line = ScanOptions::MapLine{{1e-6, 1e-6}, {9e-6, 7e-6}, 2e-6};
  const LineScan line = read_line_scan(path, options);
  ASSERT_EQ(line.position.size(), 21u);  // 10 um in pixels of 0.5 um
  EXPECT_EQ(*line.voltage, 20);
  // 10 um along, the line is 8 um to the right: 16 pixels of 2 %. The mean across is that of the
  // line itself, and the scatter across gives its standard error: five samples 0.4 x ... apart.
  EXPECT_NEAR(line.elements.at("Al").fraction[20], 0.36, 1e-6);
  EXPECT_NEAR(line.elements.at("Fe").fraction[20], 0.64, 1e-6);
  const double step = 0.02 * 0.6;  // of Al between two samples across, direction (-0.6, 0.8)
  EXPECT_NEAR(line.elements.at("Al").uncertainty[10], step * std::sqrt(2.5) / std::sqrt(5.0), 1e-6);
  EXPECT_TRUE(line.flagged.empty());
}

TEST(DescribedMap, EveryFaultIsASentence) {
  synthetic_tiff<std::uint16_t>("fe", 40, 20, [](int, int) { return 1; });
  synthetic_tiff<float>("small", 4, 4, [](int, int) { return 100; });
  ScanOptions options;
  options.map_line = ScanOptions::MapLine{{0, 0}, {1e-6, 0}, 0};
  const auto read = [&](const std::string& text) { read_line_scan(description(text), options); };
  const std::string fe = "[[element]]\nsymbol = \"Fe\"\nfile = \"synthetic_fe.tif\"\n";
  const std::string small = "[[element]]\nsymbol = \"Al\"\nfile = \"synthetic_small.tif\"\n";
  EXPECT_REFUSED(read(fe), "percent_per_count");
  EXPECT_REFUSED(read(small + fe + "percent_per_count = 1\n"), "expected equal sizes");
  EXPECT_REFUSED(read(small + small), "two maps of Al");
  EXPECT_REFUSED(read(small + "colour = 1\n"), "colour");
  EXPECT_REFUSED(read("[[element]]\nsymbol = \"Xx\"\nfile = \"synthetic_small.tif\"\n"), "\"Xx\"");
  EXPECT_NO_THROW(read(small));
  options.map_line = ScanOptions::MapLine{{0, 0}, {1e-6, 0}, 1e-6};
  EXPECT_REFUSED(read(small), "leaves the map at");
  options.map_line = ScanOptions::MapLine{{0, 0}, {0, 0}, 0};
  EXPECT_REFUSED(read(small), "at least one pixel of length");
  const fs::path cut = fs::path(testing::TempDir()) / "synthetic_fe.tif";
  fs::resize_file(cut, fs::file_size(cut) / 2);
  EXPECT_REFUSED(read(fe + "percent_per_count = 1\n"), "damaged or cut off");
}

}  // namespace
}  // namespace meltproof::validation

// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "validation/eds/concentration.hpp"
#include "validation/eds/eds_test_files.hpp"
#include "validation/eds/element_map.hpp"
#include "validation/eds/formats.hpp"
#include "validation/eds/synthetic_maps.hpp"

namespace meltproof::validation {
namespace {

namespace fs = std::filesystem;

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

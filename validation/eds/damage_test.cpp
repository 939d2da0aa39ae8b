// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever the bytes are, a reader returns or refuses with a sentence.
#include <random>

#include "base/atomic_file.hpp"
#include "validation/eds/concentration.hpp"
#include "validation/eds/eds_test_files.hpp"
#include "validation/eds/formats.hpp"
#include "validation/eds/synthetic_maps.hpp"

namespace meltproof::validation {
namespace {

namespace fs = std::filesystem;

/// Small synthetic files, one for each reader.
std::vector<fs::path> seeds() {
  SyntheticH5oina line("damage");
  line.grid(3, 1, 1);
  line.list("Composition/Al", {1, 2, 3});
  line.list("Composition Sigma/Al", {1, 1, 1});
  line.list("Live Time", {1, 1, 1});
  line.list("Peak Area/Al K series", {1, 2, 3});
  const auto spx = synthetic_file(
      "damage.spx",
      "<TRTSpectrum><ClassInstance Type=\"TRTSpectrum\"><ClassInstance "
      "Type=\"TRTSpectrumHeader\"><ChannelCount>3</ChannelCount><CalibAbs>-0.1</CalibAbs>"
      "<CalibLin>0.01</CalibLin></ClassInstance><Channels>1,2,3</Channels><ClassInstance "
      "Type=\"TRTResult\"><Result><Atom>13</Atom><MassPercent>0.5</MassPercent></Result>"
      "</ClassInstance></ClassInstance></TRTSpectrum>");
  return {line.done(),
          spx,
          synthetic_file("damage.msa",
                         "#FORMAT : EMSA/MAS\n#NPOINTS : 3\n#XUNITS : eV\n#DATATYPE : Y\n"
                         "#XPERCHAN : 10\n#OFFSET : 0\n#SPECTRUM : \n1,2,3\n#ENDOFDATA : \n"),
          synthetic_file("damage.csv",
                         "kV: 20\nX (mm),Y (mm),AlK (wt%),AlK +/- (wt%),AlK counts,FeK (wt%)\n"
                         "1.0,2.0,20,0.5,400,79\n1.3,2.4,10,0.4,100,89\n"),
          synthetic_file("damage_list.csv", "file,position [um]\nsynthetic_damage.spx,1\n"),
          synthetic_tiff<float>(
              "damage", 20, 20, [](int x, int y) { return x + y; }, true),
          synthetic_file("damage.toml",
                         "unit = \"wt%\"\npixel_size = \"1 um\"\n[[element]]\nsymbol = \"Al\"\n"
                         "file = \"synthetic_damage.tif\"\n")};
}

/// Reads a damaged file through every way in; anything but a value or a sentence fails the test.
void read_all(const fs::path& path, bool as_tiff) {
  ScanOptions options;
  options.map_line = ScanOptions::MapLine{{0, 0}, {2e-6, 2e-6}, 1e-6};
  const std::vector<std::function<void()>> ways = {
      [&] { window_counts(read_eds_export(path).spectrum.value_or(Spectrum{})); },
      [&] { concentration_by_least_squares(read_line_scan(path), steel_316l_composition()); },
      [&] {
        read_line_scan(as_tiff ? fs::path(testing::TempDir()) / "synthetic_damage.toml" : path,
                       options);
      }};
  for (const auto& way : ways) {
    try {
      way();
    } catch (const InputError& refused) {
      EXPECT_GT(std::string(refused.what()).size(), 20u) << refused.what();
    }
  }
}

TEST(Damage, EndsInAValueOrASentence) {
  std::mt19937_64 random(20);
  for (const auto& path : seeds()) {
    const std::string whole = read_file(path);
    const bool as_tiff = path.extension() == ".tif";
    const auto write = [&](const std::string& bytes) {
      std::ofstream(path, std::ios::binary) << bytes;
    };
    for (std::size_t i = 0; i < 40; ++i) {
      write(whole.substr(0, whole.size() * i / 40));
      ASSERT_NO_THROW(read_all(path, as_tiff)) << path << " cut to " << i << "/40";
    }
    for (int i = 0; i < 150; ++i) {
      std::string bytes = whole;
      for (int k = 0; k < 1 + i % 4; ++k) {
        bytes[random() % bytes.size()] = static_cast<char>(random());
      }
      write(bytes);
      ASSERT_NO_THROW(read_all(path, as_tiff)) << path << " with change " << i;
    }
    write(whole);
    ASSERT_NO_THROW(read_eds_export(as_tiff ? path.parent_path() / "synthetic_damage.csv" : path));
  }
}

}  // namespace
}  // namespace meltproof::validation

// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the synthetic seeds of the fuzzing corpus: write_seeds FOLDER makes FOLDER/<reader>/*.
#include <cstdio>
#include <filesystem>
#include <string>

#include "base/artifact.hpp"
#include "base/atomic_file.hpp"
#include "imaging/recording/synthetic_files.hpp"

using namespace meltproof;
using namespace meltproof::imaging::synthetic;

int main(int argc, char** argv) {
  if (argc != 2) {
    std::puts("write_seeds FOLDER");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  const auto write = [&](const std::string& name, const std::string& bytes) {
    std::filesystem::create_directories((folder / name).parent_path());
    write_file(folder / name, bytes);
  };
  const std::vector<Picture> film = {scene(9, 6, 0), scene(9, 6, 1), scene(9, 6, 2)};
  write("ptw/film.ptw", ptw(film));
  write("ptw/gap.ptw", ptw(film, 20));
  const auto blocks = [&](const FlirBlock& options) {
    return flir_block(film[0], options) + flir_block(film[1], options);
  };
  write("flir/raw.seq", blocks({}));
  write("flir/big.seq", blocks({.big_header = true, .big_records = true}));
  write("flir/png.fff", blocks({.pixels = Pixels::png_exchanged}));
  write("flir/jpeg_ls.csq", blocks({.pixels = Pixels::jpeg_ls}));
  write("flir/counts.seq", blocks({.camera = false}));
  write("flir/behind.seq", blocks({.camera_length = 0x310, .directory_behind = true}));
  write("flir/between.seq", flir_block(film[0], {.extra_rows = 1}) + std::string(9, '\0') +
                                flir_block(film[1], {.extra_rows = 1, .subtype = 1}));
  write("flir/exchanged.csq", blocks({.pixels = Pixels::jpeg_ls_exchanged}));
  write("flir_jpeg/raw.jpg", flir_jpeg(flir_block(film[0], {.big_header = true}), 700));
  write("flir_jpeg/png.jpg", flir_jpeg(flir_block(film[0], {.pixels = Pixels::png}), 60000));
  write("sfmov/counts.sfmov", sfmov(film, "UInt16", 3));
  write("sfmov/floats.sfmov", sfmov(film, "Flt32", 4));
  write("sfmov_include/sc8200.inc", sfmov_include());
  write("irb/chain.irb", irb(film, false));
  write("irb/runs.irb", irb(film, true));
  write("tiff/film.tif", tiff(film));
  write("tiff/imagej.tif", imagej_stack(film, 4));
  write("tiff/packed.tif", tiff_12(film[0], true));
  write("picture/a.bmp", bmp(film[0]));
  write("picture/a.png", png(film[0]));
  write("matlab_5/plain.mat", mat5(film, false));
  write("matlab_5/big.mat", mat5(film, false, true, false));
  write("matlab_5/compressed.mat", mat5(film, true));
  write("matlab_5/frames.mat", mat5_frames(film, false));
  write("matlab_5/packed_frames.mat", mat5_frames(film, true));
  for (const char* name : {"hdf5", "matlab_7"}) std::filesystem::create_directories(folder / name);
  write_hdf5(folder / "hdf5/plain.h5", "frames", film, false);
  write_hdf5(folder / "hdf5/chunks.h5", "scan/frames", film, true);
  write_matlab_7(folder / "matlab_7/film.mat", film);
  {
    meltproof::ArtifactWriter own(folder / "hdf5/own.h5", "meltproof recording");
    own.write("frames", film[0].counts, {1, 6, 9}, "count", "synthetic frames");
    own.write("time", std::vector<double>{0.5}, {1}, "s", "time of each frame");
    own.write("frame_rate", 9762.5, "Hz", "frame rate");
    own.attribute("quantity", "counts");
    own.attribute("synthetic", "a seed for fuzzing");
    own.commit({});
  }
  write("csv/comma.csv", csv(film[0], ',', '.') + "\n" + csv(film[1], ',', '.'));
  write("csv/preamble.asc",
        "[Settings]\nTempUnit=\xB0"
        "C\n[Data]\n" +
            csv(film[0], ';', ',') + "Frame 2\n" + csv(film[1], ';', ','));
  write("csv/names.csv", "Frame 1,20.1,20.2\n,21.1,21.2\nFrame 2,30.1,30.2\n,31.1,31.2\n");
  write("csv/wide.csv", std::string("\xFF\xFE"
                                    "1\0;\0"
                                    "2\0\n\0"
                                    "3\0;\0"
                                    "4\0\n\0",
                                    18));
  write("csv/gaps.txt", "1\t\t3\r\n4\tNaN\t---\r\n");
  write("csv/quoted.csv", "\"1,5\",\"2,5\"\n\"3,5\",\"4,5\"\n");
  return 0;
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/synthetic_files.hpp"

#include <bit>
#include <cmath>

#include <fmt/format.h>
#include <hdf5.h>

#include "imaging/recording/synthetic_bytes.hpp"

namespace meltproof::imaging::synthetic {
namespace {

using u16 = std::uint16_t;
using u32 = std::uint32_t;

std::string pixel_bytes(const Picture& picture, bool big) {
  Bytes b;
  for (const u16 count : picture.counts) b.add(count, big);
  return b.text;
}

}  // namespace

Picture scene(std::size_t width, std::size_t height, std::size_t frame) {
  Picture p{width, height, {}};
  u32 noise = 12345 + static_cast<u32>(frame);
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      noise = noise * 1664525 + 1013904223;
      const double dx = static_cast<double>(x) - static_cast<double>(frame) - 2;
      const double dy = static_cast<double>(y) - static_cast<double>(height) / 2;
      p.counts.push_back(
          static_cast<u16>(17000 + 3000 * std::exp(-(dx * dx + dy * dy) / 8) + (noise >> 28)));
    }
  return p;
}

std::string ptw(const std::vector<Picture>& frames, std::size_t gap) {
  const u32 main_header = 1024, frame_header = 128;
  const auto pixels = static_cast<u32>(frames[0].counts.size());
  Bytes b;
  b.text.assign(main_header, '\0');
  b.text.replace(0, 3, "CED");
  b.put(11, main_header);
  b.put(15, frame_header);
  const auto behind = static_cast<u32>(gap);
  b.put(19, gap > 0 ? frame_header + 2 * pixels + behind : frame_header / 2 + pixels);
  b.put(23, gap > 0 ? 2 * pixels + behind : pixels);
  b.put(27, static_cast<u32>(frames.size()));
  b.put(141, 0.95F);
  b.put(145, 293.15F);
  b.put(377, static_cast<u16>(frames[0].width));
  b.put(379, static_cast<u16>(frames[0].height));
  b.put(381, u16{14});
  b.put(403, 0.01F);
  b.put(407, 0.0005F);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    std::string head(frame_header, '\0');
    head[82] = static_cast<char>(i);  // hundredths of a second
    b.text += head + pixel_bytes(frames[i], false) + std::string(gap, '\x7F');
  }
  return b.text;
}

std::string sfmov(const std::vector<Picture>& frames, const std::string& type,
                  std::size_t announced) {
  std::string text = fmt::format(
      "HdSize auto\nADBits 14\nxPixls {}\nyPixls {}\nDaType {}\nInclude rec.inc\nNumDPs {}\n"
      "saf_padding 00000000DATA0000\nDATA\r\n",
      frames[0].width, frames[0].height, type, announced);
  for (const auto& frame : frames) {
    if (type == "Flt32") {
      Bytes b;
      for (const u16 count : frame.counts) b.add(static_cast<float>(count) / 4);
      text += b.text;
    } else {
      text += pixel_bytes(frame, false);
    }
  }
  return text;
}

std::string sfmov_include() {
  return "HdSize auto\r\nFRate_0 30\r\nITime_0 6.68608\r\n"
         "nfcB_0 3.13772860649615e+003\r\nnfcBandpassHigh_0 4.90000000000000e+000\r\n"
         "nfcBandpassLow_0 3.00000000000000e+000\r\nnfcC0_0 -7.45567590398151e-005\r\n"
         "nfcC1_0 3.71618922472575e-008\r\nnfcC2_0 -1.04927595246710e-013\r\n"
         "nfcC3_0 0.00000000000000e+000\r\nnfcF_0 1.00000000000000e+000\r\n"
         "nfcMaxCounts_0 13319\r\nnfcMaxTemp_0 5.50000000000000e+001\r\nnfcMinCounts_0 2634\r\n"
         "nfcMinTemp_0 -2.00000000000000e+001\r\nnfcR_0 5.72495803288052e+000\r\nDATA\r\n";
}

std::string irb(const std::vector<Picture>& frames, bool compressed, u32 period) {
  Bytes b;
  b.text.assign(64, '\0');
  b.text.replace(0, 13, std::string("\xFFIRB\0VARIOCAM", 13));
  b.put(25, u32{64});
  b.put(29, u32{2});
  std::size_t directory = 64;
  b.text.resize(128);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto& picture = frames[i];
    Bytes f;
    f.text.assign(1728, '\0');
    f.put(0, u16{2});
    f.put(2, static_cast<u16>(compressed ? 1 : 0));
    f.put(4, static_cast<u16>(picture.width));
    f.put(6, static_cast<u16>(picture.height));
    f.put(24, 0.9F);
    f.put(28, 0.5F);
    f.put(32, 298.15F);
    f.put(40, 297.15F);
    f.put(48, 4.F);
    for (std::size_t k = 0; k < 256; ++k) f.put(60 + 4 * k, 250 + static_cast<float>(k));
    f.put(1176, 260.F);
    f.put(1180, 500.F);
    f.put(1624, 41653.75);
    f.put(1632, 5000 + period * static_cast<u32>(i));
    if (compressed) {
      std::string runs;
      for (std::size_t k = 0; k < picture.counts.size();) {
        const auto high = picture.counts[k] >> 8;
        std::size_t n = 0;
        for (; k < picture.counts.size() && picture.counts[k] >> 8 == high && n < 255; ++k, ++n)
          f.add(static_cast<std::uint8_t>(picture.counts[k] & 0xFF));
        runs += {static_cast<char>(n), static_cast<char>(high)};
      }
      f.text += runs;
    } else {
      f.text += pixel_bytes(picture, false);
    }
    const auto place = b.text.size();
    b.text += f.text;
    b.put(directory, u32{1});
    b.put(directory + 8, static_cast<u32>(i));
    b.put(directory + 12, static_cast<u32>(place));
    b.put(directory + 16, static_cast<u32>(f.text.size()));
    if (i + 1 == frames.size()) break;
    b.put(directory + 32, u32{4});
    b.put(directory + 44, static_cast<u32>(b.text.size()));
    b.put(directory + 48, u32{64});
    directory = b.text.size();
    b.text.resize(directory + 64);
  }
  return b.text;
}

void write_hdf5(const std::filesystem::path& path, const std::string& name,
                const std::vector<Picture>& frames, bool chunked) {
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hsize_t dims[3] = {frames.size(), frames[0].height, frames[0].width};
  const hsize_t chunk[3] = {1, dims[1], dims[2]};
  const hid_t space = H5Screate_simple(3, dims, nullptr);
  const hid_t layout = H5Pcreate(H5P_DATASET_CREATE), links = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  if (chunked) {
    H5Pset_chunk(layout, 3, chunk);
    H5Pset_deflate(layout, 4);
  }
  const hid_t set =
      H5Dcreate2(file, name.c_str(), H5T_STD_U16LE, space, links, layout, H5P_DEFAULT);
  std::vector<u16> all;
  for (const auto& frame : frames) all.insert(all.end(), frame.counts.begin(), frame.counts.end());
  H5Dwrite(set, H5T_NATIVE_UINT16, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data());
  H5Dclose(set);
  H5Pclose(links);
  H5Pclose(layout);
  H5Sclose(space);
  H5Fclose(file);
}

void write_matlab_7(const std::filesystem::path& path, const std::vector<Picture>& frames) {
  const hid_t creation = H5Pcreate(H5P_FILE_CREATE);
  H5Pset_userblock(creation, 512);
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, H5P_DEFAULT);
  // MATLAB's first index is the fastest, HDF5's last: the shape is turned round.
  const hsize_t dims[3] = {frames.size(), frames[0].width, frames[0].height};
  const hid_t space = H5Screate_simple(3, dims, nullptr);
  const hid_t set =
      H5Dcreate2(file, "frames", H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  std::vector<double> all;
  for (const auto& f : frames)
    for (std::size_t x = 0; x < f.width; ++x)
      for (std::size_t y = 0; y < f.height; ++y) all.push_back(f.counts[y * f.width + x]);
  H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data());
  H5Dclose(set);
  H5Sclose(space);
  H5Fclose(file);
  H5Pclose(creation);
  Bytes b;
  b.text = "MATLAB 7.3 MAT-file, Platform: GLNXA64, synthetic HDF5 schema 1.00 .";
  b.text.resize(124, ' ');
  b.text += std::string("\0\2IM", 4);
  overwrite_beginning(path, b.text);
}

std::string csv(const Picture& picture, char separator, char decimal) {
  std::string text;
  for (std::size_t i = 0; i < picture.counts.size(); ++i) {
    std::string value = fmt::format("{:.2f}", picture.counts[i] / 100.0);
    value[value.find('.')] = decimal;
    text += value + ((i + 1) % picture.width == 0 ? '\n' : separator);
  }
  return text;
}

}  // namespace meltproof::imaging::synthetic

// SPDX-License-Identifier: GPL-3.0-or-later
// FLIR's blocks and MATLAB 5, whose parts are longer.
#include <algorithm>

#include <charls/charls.h>
#include <zlib.h>

#include "imaging/recording/synthetic_bytes.hpp"
#include "imaging/recording/synthetic_files.hpp"

namespace meltproof::imaging::synthetic {
namespace {

using u16 = std::uint16_t;
using u32 = std::uint32_t;

std::string jpeg_ls(const Picture& picture) {
  charls::jpegls_encoder encoder;
  encoder.frame_info({static_cast<u32>(picture.width), static_cast<u32>(picture.height), 16, 1});
  std::string bytes(encoder.estimated_destination_size(), '\0');
  encoder.destination(bytes);
  bytes.resize(encoder.encode(picture.counts));
  return bytes;
}

std::string stored(const Picture& picture, const FlirBlock& options) {
  Picture exchanged = picture;
  for (auto& count : exchanged.counts) count = static_cast<u16>(count >> 8 | count << 8);
  switch (options.pixels) {
    case Pixels::png:
      return png(picture);
    case Pixels::png_exchanged:
      return png(exchanged);
    case Pixels::jpeg_ls:
      return jpeg_ls(picture);
    case Pixels::jpeg_ls_exchanged:
      return jpeg_ls(exchanged);
    default:
      break;
  }
  Bytes b;
  for (const u16 count : picture.counts) b.add(count, options.big_records);
  return b.text;
}

std::string camera_record(const FlirBlock& options) {
  const bool big = options.big_records;
  Bytes b;
  b.text.assign(0x466, '\0');
  b.put(0, u16{2}, big);
  const std::pair<std::size_t, float> floats[] = {
      {0x20, .95F},      {0x24, 1.F},      {0x28, 293.15F},  {0x2C, 293.15F},
      {0x30, 293.15F},   {0x34, 1.F},      {0x3C, .5F},      {0x58, 21106.76953125F},
      {0x5C, 1501.F},    {0x60, 1.F},      {0x70, .006569F}, {0x74, .01262F},
      {0x78, -.002276F}, {0x7C, -.00667F}, {0x80, 1.9F},     {0x30C, 0.012545257806777954F}};
  for (const auto& [at, value] : floats) b.put(at, value, big);
  b.put(0x308, std::int32_t{-7340}, big);
  b.put(0x384, options.seconds, big);
  b.put(0x388, options.milliseconds, big);
  b.put(0x464, options.frame_rate, big);
  return b.text.substr(0, options.camera_length);
}

}  // namespace

std::string flir_block(const Picture& picture, const FlirBlock& options) {
  const bool big = options.big_records;
  Bytes raw;
  raw.text.assign(32, '\0');
  raw.put(0, u16{2}, big);
  raw.put(2, static_cast<u16>(picture.width), big);
  raw.put(4, static_cast<u16>(picture.height), big);
  raw.text += stored(picture, options);
  raw.text.append(2 * picture.width * options.extra_rows, '\0');
  const u16 kinds[] = {static_cast<u16>(big ? 1 : 2), 3, 3, 4, 4};
  const u16 kind = options.subtype != 0 ? options.subtype : kinds[static_cast<int>(options.pixels)];
  Bytes b, directory;
  directory.text.assign(3 * 32, '\0');
  b.text.assign(64, '\0');
  b.text.replace(0, 3, "FFF");
  b.put(0x14, u32{100}, options.big_header);
  b.put(0x1C, u32{3}, options.big_header);
  if (!options.directory_behind) b.text.append(directory.text.size(), '\0');
  const auto add_record = [&](std::size_t entry, u16 type, u16 subtype, const std::string& bytes) {
    directory.put(32 * entry, type, options.big_header);
    directory.put(2 + 32 * entry, subtype, options.big_header);
    directory.put(12 + 32 * entry, static_cast<u32>(b.text.size()), options.big_header);
    directory.put(16 + 32 * entry, static_cast<u32>(bytes.size()), options.big_header);
    b.text += bytes;
  };
  if (options.camera) add_record(0, 0x20, 1, camera_record(options));
  add_record(2, 1, kind, raw.text);  // entry 1 stays empty
  if (options.directory_behind) {
    b.put(0x18, static_cast<u32>(b.text.size()), options.big_header);
    return b.text + directory.text;
  }
  b.put(0x18, u32{64}, options.big_header);
  return b.text.replace(64, directory.text.size(), directory.text);
}

std::string flir_jpeg(const std::string& block, std::size_t part) {
  Bytes b;
  b.text = "\xFF\xD8\xFF\xE0";
  b.add(u16{16}, true);
  b.text += std::string("JFIF\0\1\1\0\0\1\0\1\0\0", 14);
  const std::size_t parts = (block.size() + part - 1) / part;
  for (std::size_t i = 0; i < parts; ++i) {
    const std::string content = block.substr(i * part, part);
    b.text += "\xFF\xE1";
    b.add(static_cast<u16>(2 + 8 + content.size()), true);
    b.text += std::string("FLIR\0\1", 6);
    b.add(static_cast<std::uint8_t>(i));
    b.add(static_cast<std::uint8_t>(parts - 1));
    b.text += content;
  }
  return b.text + "\xFF\xDA and a picture for the eye \xFF\xD9";
}

namespace {

/// An element of a MATLAB 5 file, filled up to 8 bytes.
std::string element(u32 type, const std::string& content, bool big) {
  Bytes b;
  b.add(type, big);
  b.add(static_cast<u32>(content.size()), big);
  b.text += content;
  b.text.resize((b.text.size() + 7) / 8 * 8);
  return b.text;
}

std::string variable(const std::string& name, const std::vector<u32>& shape, bool doubles,
                     const std::string& data, bool big) {
  Bytes flags, dims;
  flags.add(u32{doubles ? 6U : 7U}, big);
  flags.add(u32{0}, big);
  for (const u32 n : shape) dims.add(n, big);
  return element(14,
                 element(6, flags.text, big) + element(5, dims.text, big) + element(1, name, big) +
                     element(doubles ? 9 : 7, data, big),
                 big);
}

std::string deflated(const std::string& bytes, bool big) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size,
           reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  packed.resize(size);
  Bytes b;  // unlike others, a compressed element is not filled up
  b.add(u32{15}, big);
  b.add(static_cast<u32>(size), big);
  return b.text + packed;
}

/// The counts of pictures as MATLAB stores them: the first index is the fastest.
std::string columns(const std::vector<Picture>& frames, bool doubles, bool big) {
  Bytes data;
  for (const auto& f : frames)
    for (std::size_t x = 0; x < f.width; ++x)
      for (std::size_t y = 0; y < f.height; ++y) {
        const u16 count = f.counts[y * f.width + x];
        if (doubles)
          data.add(static_cast<double>(count), big);
        else
          data.add(static_cast<float>(count), big);
      }
  return data.text;
}

std::string mat5_head(bool big_endian) {
  Bytes b;
  b.text = "MATLAB 5.0 MAT-file, Platform: GLNXA64, synthetic";
  b.text.resize(124, ' ');
  b.add(u16{0x0100}, big_endian);
  return b.text + (big_endian ? "MI" : "IM");
}

}  // namespace

std::string mat5_frames(const std::vector<Picture>& frames, bool compressed) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < frames.size(); ++i) names.push_back("Frame" + std::to_string(i));
  std::sort(names.begin(), names.end());
  std::string text = mat5_head(false);
  for (const auto& name : names) {
    const auto& picture = frames[std::stoul(name.substr(5))];
    Bytes time;
    for (const double part : {2026.0, 11.0, 28.0, 13.0, 40.0, 7.0, 512.0}) time.add(part);
    for (const auto& v :
         {variable(name, {static_cast<u32>(picture.height), static_cast<u32>(picture.width)}, true,
                   columns({picture}, true, false), false),
          variable(name + "_DateTime", {1, 7}, true, time.text, false)})
      text += compressed ? deflated(v, false) : v;
  }
  return text;
}

std::string mat5(const std::vector<Picture>& frames, bool compressed, bool big_endian, bool doubles,
                 bool colour) {
  Bytes rate;
  rate.add(9762.5, big_endian);
  const std::string scalar = variable("rate", {1, 1}, true, rate.text, big_endian);
  std::vector<u32> shape = {static_cast<u32>(frames[0].height), static_cast<u32>(frames[0].width),
                            static_cast<u32>(frames.size())};
  if (colour) shape.insert(shape.begin() + 2, 1);
  const std::string stack =
      variable("frames", shape, doubles, columns(frames, doubles, big_endian), big_endian);
  return mat5_head(big_endian) +
         (compressed ? deflated(scalar, big_endian) + deflated(stack, big_endian) : scalar + stack);
}

}  // namespace meltproof::imaging::synthetic

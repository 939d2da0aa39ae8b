// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/flir_pixels.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include <charls/charls.h>
#include <fmt/format.h>

#include "imaging/recording/png_counts.hpp"

namespace meltproof::imaging {
namespace {

std::string stored_pixels(const ByteFile& file, const FlirBlock& block) {
  return file.bytes(block.raw.place + flir_raw_header, block.raw.length - flir_raw_header);
}

float exchange(float value) {
  const auto v = static_cast<std::uint16_t>(value);
  return static_cast<float>(static_cast<std::uint16_t>(v >> 8 | v << 8));
}

void decode_png(const ByteFile& file, const FlirBlock& block, std::size_t frame,
                std::vector<float>& counts) {
  const std::string problem =
      decode_png_counts(stored_pixels(file, block), block.width, block.height, counts);
  if (!problem.empty())
    refuse_flir_frame(file, frame, "holds a PNG that " + problem + "; the file is damaged.");
}

void decode_jpeg_ls(const ByteFile& file, const FlirBlock& block, std::size_t frame,
                    std::vector<float>& counts) {
  std::string bytes = stored_pixels(file, block);
  // CharLS spends ten seconds on a stream that ends without its end mark, before it refuses it.
  const auto end = bytes.rfind("\xFF\xD9");
  if (end == std::string::npos)
    refuse_flir_frame(file, frame, "holds a JPEG-LS that ends early; the file is damaged.");
  bytes.resize(end + 2);
  bytes.append(16, '\0');  // it looks ahead by words
  try {
    const charls::jpegls_decoder decoder(bytes, true);
    const auto& info = decoder.frame_info();
    // The size is compared before anything is decoded: what a damaged head claims asks for no
    // memory.
    if (info.width != block.width || info.height != block.height || info.component_count != 1)
      refuse_flir_frame(
          file, frame,
          fmt::format("holds a JPEG-LS of {} x {} pixels in {} channels, but says {} x {} in one; "
                      "the file is damaged.",
                      info.width, info.height, info.component_count, block.width, block.height));
    std::string samples(decoder.destination_size(), '\0');
    decoder.decode(samples);
    if (info.bits_per_sample > 8)
      widen(samples, std::endian::native, counts);
    else
      std::transform(samples.begin(), samples.end(), counts.begin(),
                     [](char c) { return static_cast<float>(static_cast<unsigned char>(c)); });
  } catch (const charls::jpegls_error& error) {
    refuse_flir_frame(
        file, frame,
        fmt::format("holds a JPEG-LS that cannot be decoded ({}); the file is damaged.",
                    error.what()));
  }
}

}  // namespace

bool flir_bytes_are_exchanged(const ByteFile& file, const FlirBlock& block, std::size_t frame) {
  std::vector<float> counts(block.width * block.height);
  read_flir_counts(file, block, false, frame, counts);
  double as_stored = 0, exchanged = 0;
  for (std::size_t i = 1; i < counts.size(); ++i) {
    if (i % block.width == 0) continue;
    as_stored += std::abs(static_cast<double>(counts[i] - counts[i - 1]));
    exchanged += std::abs(static_cast<double>(exchange(counts[i]) - exchange(counts[i - 1])));
  }
  switch (block.coding) {
    case FlirCoding::png:
      return exchanged <= as_stored;
    case FlirCoding::jpeg_ls:
      return 4 * exchanged < as_stored;
    case FlirCoding::raw:
      break;
  }
  return exchanged < as_stored;
}

void read_flir_counts(const ByteFile& file, const FlirBlock& block, bool exchanged,
                      std::size_t frame, std::vector<float>& counts) {
  switch (block.coding) {
    case FlirCoding::raw:
      widen(file.bytes(block.raw.place + flir_raw_header, 2 * counts.size()), block.order, counts);
      break;
    case FlirCoding::jpeg_ls:
      decode_jpeg_ls(file, block, frame, counts);
      break;
    case FlirCoding::png:
      decode_png(file, block, frame, counts);
      break;
  }
  if (exchanged) std::transform(counts.begin(), counts.end(), counts.begin(), exchange);
}

}  // namespace meltproof::imaging

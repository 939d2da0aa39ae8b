// SPDX-License-Identifier: GPL-3.0-or-later
// A PNG is its mark of 8 bytes and chunks: u32 length, four letters, the content, u32 CRC-32 of
// letters and content; all big endian. The first is IHDR (width, height, bits, colour), the last
// IEND.
#include "imaging/recording/png_counts.hpp"

#include <bit>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <zlib.h>

#include "imaging/recording/bytes.hpp"

namespace meltproof::imaging {
namespace {

constexpr std::string_view mark = "\x89PNG\r\n\x1a\n";

std::uint32_t big_u32(std::string_view bytes, std::size_t at) {
  return number_at<std::uint32_t>(std::string(bytes.substr(at, 4)), 0, std::endian::big);
}

}  // namespace

std::optional<PngHeader> png_header(std::string_view bytes) {
  if (bytes.size() < 33 || !bytes.starts_with(mark) || bytes.substr(12, 4) != "IHDR")
    return std::nullopt;
  return PngHeader{big_u32(bytes, 16), big_u32(bytes, 20), static_cast<unsigned char>(bytes[24]),
                   static_cast<unsigned char>(bytes[25])};
}

bool png_is_whole(std::string_view bytes) {
  if (!bytes.starts_with(mark)) return false;
  for (std::size_t at = mark.size(); bytes.size() - at >= 12;) {
    const std::size_t length = big_u32(bytes, at);
    if (length > bytes.size() - at - 12) return false;
    const auto letters_and_content = bytes.substr(at + 4, length + 4);
    const auto sum = crc32(0, reinterpret_cast<const Bytef*>(letters_and_content.data()),
                           static_cast<uInt>(letters_and_content.size()));
    if (sum != big_u32(bytes, at + 8 + length)) return false;
    if (letters_and_content.starts_with("IEND")) return true;
    at += length + 12;
  }
  return false;
}

std::string decode_png_counts(const std::string& bytes, std::size_t width, std::size_t height,
                              std::vector<float>& counts) {
  const auto header = png_header(bytes);
  if (!header || !png_is_whole(bytes)) return "ends early or has a wrong checksum";
  if (header->width != width || header->height != height || header->bits != 16 ||
      header->colour != 0)
    return fmt::format(
        "has {} x {} pixels of {} bits and colour type {}, not {} x {} grey ones "
        "of 16 bits",
        header->width, header->height, header->bits, header->colour, width, height);
  cv::Mat image;
  try {
    const std::vector<unsigned char> buffer(bytes.begin(), bytes.end());
    image = cv::imdecode(buffer, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    image.release();  // told below, like a picture that cannot be decoded quietly
  }
  if (image.type() != CV_16UC1 || image.cols != static_cast<int>(width) ||
      image.rows != static_cast<int>(height))
    return "cannot be decoded";
  cv::Mat values(image.rows, image.cols, CV_32F, counts.data());
  image.convertTo(values, CV_32F);
  return "";
}

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/picture.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "base/error.hpp"
#include "imaging/recording/bytes.hpp"
#include "imaging/recording/png_counts.hpp"

namespace meltproof::imaging {
namespace {

/// What a picture says of its size.
struct Size {
  std::uint64_t width = 0, height = 0;
  bool whole = false;  // whether all its bytes are there
};

/// A BMP states where its pixels begin (10), width (18), height (22, negative from the top down),
/// bits a pixel (28) and compression (30); rows are padded to four bytes.
Size bmp_size(const std::filesystem::path& path, const std::string& bytes) {
  constexpr std::size_t head = 34;
  if (bytes.size() < head) return {};
  constexpr auto little = std::endian::little;
  const auto start = std::uint64_t{number_at<std::uint32_t>(bytes, 10, little)};
  const auto width = std::int64_t{number_at<std::int32_t>(bytes, 18, little)};
  const auto height = std::abs(std::int64_t{number_at<std::int32_t>(bytes, 22, little)});
  const auto bits = std::uint64_t{number_at<std::uint16_t>(bytes, 28, little)};
  const auto packed = number_at<std::uint32_t>(bytes, 30, little);
  if (packed != 0 && packed != 3)  // 3: colours by masks, of which the channels are looked at later
    throw InputError(path.string() + ": the BMP is compressed (run-length coded, kind " +
                     std::to_string(packed) +
                     "), where pixels may be left out; save it uncompressed.");
  const auto w = static_cast<std::uint64_t>(std::max<std::int64_t>(0, width));
  const auto h = static_cast<std::uint64_t>(height);
  const std::uint64_t row = (w * bits + 31) / 32 * 4;
  const bool whole = start <= bytes.size() && (row == 0 || h <= (bytes.size() - start) / row);
  return {w, h, whole};
}

/// OpenCV fills what a file does not hold with zeros and says nothing, and asks for as much memory
/// as a damaged size says, so both are checked here.
void check_complete(const std::filesystem::path& path, const std::string& bytes) {
  // DEFLATE gains a factor of 1032 at most, and PNG has pixels of one bit.
  constexpr std::uint64_t most_pixels_per_byte = 8256;
  Size size;
  if (bytes.starts_with("BM"))
    size = bmp_size(path, bytes);
  else if (const auto header = png_header(bytes))
    size = {header->width, header->height, png_is_whole(bytes)};
  if (!size.whole)
    throw InputError(
        path.string() + ": the picture ends before its last row, or a checksum in it is wrong (" +
        std::to_string(bytes.size()) +
        " bytes are there); a picture is one frame, so nothing is left to read. Copy it "
        "again from its source.");
  RecordingHeader header;
  header.path = path;
  header.width = size.width;
  header.height = size.height;
  check_frame_size(header);
  if (size.width * size.height > most_pixels_per_byte * bytes.size())
    throw InputError(path.string() + ": the picture is said to have " + std::to_string(size.width) +
                     " x " + std::to_string(size.height) +
                     " pixels, which its bytes cannot hold; it is damaged.");
}

}  // namespace

bool is_picture(std::string_view first_bytes) {
  // Bytes 6 to 9 of a BMP are reserved and zero, which no text beginning with BM has.
  const bool bmp = first_bytes.size() > 26 && first_bytes.substr(0, 2) == "BM" &&
                   first_bytes.substr(6, 4) == std::string_view("\0\0\0\0", 4);
  return bmp || first_bytes.starts_with("\x89PNG\r\n\x1a\n");
}

Recording open_picture(const std::filesystem::path& path) {
  const ByteFile file(path);
  const std::string bytes = file.bytes(0, file.size());
  check_complete(path, bytes);
  const std::vector<unsigned char> buffer(bytes.begin(), bytes.end());
  cv::Mat image;
  try {
    image = cv::imdecode(buffer, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    image.release();  // told below, like a picture that cannot be decoded quietly
  }
  if (image.empty())
    throw InputError(path.string() +
                     ": the picture is damaged or of a kind that OpenCV cannot decode.");
  if (image.channels() != 1) {
    std::vector<cv::Mat> channels;
    cv::split(image, channels);
    for (std::size_t i = 1; i < 3 && i < channels.size(); ++i)
      if (cv::norm(channels[0], channels[i], cv::NORM_INF) > 0)
        throw InputError(
            path.string() +
            ": the picture is coloured, and colours are no signal; export the camera's "
            "grey values.");
    image = channels[0];
  }
  RecordingHeader header;
  header.path = path;
  header.width = static_cast<std::size_t>(image.cols);
  header.height = static_cast<std::size_t>(image.rows);
  header.frames = 1;
  header.saturation = image.depth() == CV_16U ? 65535 : 255;
  header.under_range = 0;
  header.notes.push_back("A picture holds no times: frame rate and integration time are unknown.");
  cv::Mat values;
  image.convertTo(values, CV_32F);
  return {header, [values](std::size_t, Frame& frame) {
            for (int row = 0; row < values.rows; ++row)
              std::copy(values.ptr<float>(row), values.ptr<float>(row) + values.cols,
                        frame.values.begin() + static_cast<std::ptrdiff_t>(row) * values.cols);
          }};
}

}  // namespace meltproof::imaging

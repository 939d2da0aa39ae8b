// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/picture.hpp"

#include <bit>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "base/error.hpp"
#include "imaging/recording/bytes.hpp"

namespace meltproof::imaging {
namespace {

constexpr std::string_view png_mark = "\x89PNG\r\n\x1a\n";

/// OpenCV fills what a file does not hold with zeros and says nothing, so the length is checked
/// here. A BMP states where its pixels begin (10), width (18), height (22), bits a pixel (28) and
/// compression (30); rows are padded to four bytes. A PNG ends with the chunk IEND.
void check_complete(const std::filesystem::path& path, const std::string& bytes) {
  bool whole = false;
  if (bytes.starts_with("BM")) {
    if (bytes.size() >= 34) {
      constexpr auto little = std::endian::little;
      const auto start = std::int64_t{number_at<std::uint32_t>(bytes, 10, little)};
      const auto width = std::int64_t{number_at<std::int32_t>(bytes, 18, little)};
      const auto height = std::abs(std::int64_t{number_at<std::int32_t>(bytes, 22, little)});
      const auto bits = std::int64_t{number_at<std::uint16_t>(bytes, 28, little)};
      const bool packed =
          number_at<std::uint32_t>(bytes, 30, little) == 1;  // run lengths: size unknown
      whole = packed || start + (width * bits + 31) / 32 * 4 * height <=
                            static_cast<std::int64_t>(bytes.size());
    }
  } else {
    whole = bytes.find("IEND", bytes.size() - std::min<std::size_t>(bytes.size(), 16)) !=
            std::string::npos;
  }
  if (!whole)
    throw InputError(
        path.string() + ": the picture ends before its last row (" + std::to_string(bytes.size()) +
        " bytes are there); a picture is one frame, so nothing is left to read. Copy it "
        "again from its source.");
}

}  // namespace

bool is_picture(std::string_view first_bytes) {
  // Bytes 6 to 9 of a BMP are reserved and zero, which no text beginning with BM has.
  const bool bmp = first_bytes.size() > 26 && first_bytes.substr(0, 2) == "BM" &&
                   first_bytes.substr(6, 4) == std::string_view("\0\0\0\0", 4);
  return bmp || first_bytes.starts_with(png_mark);
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

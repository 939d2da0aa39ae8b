// SPDX-License-Identifier: GPL-3.0-or-later
// A JPEG is a row of segments: FF, a marker, u16 length big endian (which counts itself), content.
// Segments APP1 (E1) whose content begins with FLIR\0 carry parts of one FLIR block: a byte 1, the
// number of the part from 0, the number of the last part, then the bytes. SOS (DA) begins the
// compressed picture, behind which no segment follows that matters here.
#include "imaging/recording/flir_jpeg.hpp"

#include <map>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "base/error.hpp"
#include "imaging/recording/bytes.hpp"
#include "imaging/recording/flir.hpp"

namespace meltproof::imaging {
namespace {

constexpr unsigned app1 = 0xE1, start_of_scan = 0xDA, end_of_image = 0xD9, fill = 0xFF;
constexpr std::uint64_t part_head = 8;

/// A marker that stands alone, without a length: TEM, RST0 to RST7, SOI.
bool stands_alone(unsigned marker) { return marker == 1 || (marker >= 0xD0 && marker <= 0xD8); }

struct Parts {
  std::map<unsigned, std::string> content;  // by number
  unsigned last = 0;
};

Parts collect_parts(const ByteFile& file) {
  Parts parts;
  std::uint64_t at = 2;  // behind SOI
  while (file.size() - at >= 4) {
    const std::string head = file.bytes(at, 4);
    const auto byte = [&](std::size_t i) { return unsigned{static_cast<unsigned char>(head[i])}; };
    if (byte(0) != 0xFF || byte(1) == start_of_scan || byte(1) == end_of_image) break;
    if (byte(1) == fill || stands_alone(byte(1))) {
      at += byte(1) == fill ? 1 : 2;
      continue;
    }
    const std::uint64_t length = byte(2) << 8 | byte(3);
    if (length < 2 || length > file.size() - at - 2)
      throw InputError(
          fmt::format("{}: a segment of the JPEG at byte {} is cut off or damaged; "
                      "copy the file again from its source.",
                      file.path().string(), at));
    if (byte(1) == app1 && length >= 2 + part_head) {
      const std::string content = file.bytes(at + 4, length - 2);
      if (content.starts_with(std::string_view("FLIR\0", 5))) {
        parts.last = static_cast<unsigned char>(content[7]);
        parts.content.emplace(static_cast<unsigned char>(content[6]), content.substr(part_head));
      }
    }
    at += 2 + length;
  }
  return parts;
}

}  // namespace

bool is_flir_jpeg(std::string_view first_bytes) { return first_bytes.starts_with("\xFF\xD8\xFF"); }

Recording open_flir_jpeg(const std::filesystem::path& path) {
  const ByteFile file(path);
  const Parts parts = collect_parts(file);
  if (parts.content.empty())
    throw InputError(path.string() +
                     ": the JPEG carries no radiometric data of FLIR, and its colours are no "
                     "signal; give the camera's original file, or export 16-bit TIFF.");
  std::string whole;
  for (unsigned i = 0; i <= parts.last; ++i) {
    const auto part = parts.content.find(i);
    if (part == parts.content.end())
      throw InputError(fmt::format(
          "{}: part {} of {} of the radiometric data is missing; the picture was edited or is "
          "damaged, give the camera's original file.",
          path.string(), i + 1, parts.last + 1));
    whole += part->second;
  }
  if (!is_flir(whole))
    throw InputError(path.string() +
                     ": the radiometric data in the JPEG begin with none of FLIR's marks; export "
                     "the picture from the camera's software as 16-bit TIFF.");
  return open_flir_blocks(ByteFile(path, std::move(whole)));
}

}  // namespace meltproof::imaging

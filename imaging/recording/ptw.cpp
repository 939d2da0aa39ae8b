// SPDX-License-Identifier: GPL-3.0-or-later
// Layout, all little endian. Main header: "CED" at 0; u32 at 11 and 15 the sizes of the main and of
// a frame's header in bytes; u32 at 19 and 23 the sizes of a frame with and without its header in
// 16-bit words (not bytes); u32 at 27 the number of frames; f32 at 141 emissivity, 145 ambient
// temperature in K, 403 period in s, 407 integration time in s; u16 at 377 width, 379 height, 381
// bits; u16 at 277 tells whether the software rescaled the values. Each frame is its header, then
// width x height u16. The frame's header stamps the time: minute, hour, hundredth and second as
// bytes from 80 on. A lock-in recording has four marked words and its reference signal in the first
// row.
#include "imaging/recording/ptw.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "base/error.hpp"
#include "imaging/recording/bytes.hpp"

namespace meltproof::imaging {
namespace {

constexpr auto little = std::endian::little;
constexpr std::uint64_t smallest_header = 411;  // up to the integration time
constexpr std::size_t stamp = 80, stamp_end = 84;

/// The time of day in a frame's header, s.
double time_of_day(const ByteFile& file, std::uint64_t frame_start) {
  const std::string b = file.bytes(frame_start + stamp, stamp_end - stamp);
  const auto at = [&](std::size_t i) {
    return static_cast<double>(static_cast<unsigned char>(b[i]));
  };
  return at(1) * 3600 + at(0) * 60 + at(3) + at(2) * 0.01;
}

/// Bytes from one frame to the next: what the header says of the pictures, or any of its sizes with
/// which the announced frames fill the file exactly, since not all software counts in words.
/// @returns 0 if none will do.
std::uint64_t frame_stride(std::uint64_t room, std::uint64_t frames, std::uint64_t frame_header,
                           std::uint64_t pixels, std::uint64_t frame_size,
                           std::uint64_t picture_size) {
  const std::uint64_t plain = frame_header + 2 * pixels;
  for (const std::uint64_t stride : {plain, 2 * frame_size, frame_size})
    if (stride > 0 && stride >= plain && frames > 0 && room / stride == frames &&
        room % stride == 0)
      return stride;
  return picture_size == pixels || picture_size == 2 * pixels ? plain : 0;
}

/// Whether the first row of the first frame is a lock-in reference instead of pixels.
bool has_lock_in_row(const ByteFile& file, std::uint64_t pixels_at, std::uint64_t width) {
  constexpr std::uint16_t marks[] = {1220, 3907, 1204, 2382};
  if (width < std::size(marks)) return false;
  const std::string row = file.bytes(pixels_at, sizeof marks);
  for (std::size_t i = 0; i < std::size(marks); ++i)
    if (number_at<std::uint16_t>(row, 2 * i, little) != marks[i]) return false;
  return true;
}

}  // namespace

bool is_ptw(std::string_view first_bytes) {
  // A text may begin with the same letters, so the two bytes that fill the signature count too, and
  // what stands for the sizes of the headers.
  if (first_bytes.size() < 19 || !first_bytes.starts_with("CED")) return false;
  if (first_bytes[3] == '\0') return true;
  const auto main_header = number_at<std::uint32_t>(std::string(first_bytes), 11, little);
  return first_bytes[3] == ' ' && main_header >= smallest_header && main_header < 1 << 20;
}

Recording open_ptw(const std::filesystem::path& path) {
  const ByteFile file(path);
  if (file.size() < smallest_header)
    throw InputError(
        fmt::format("{}: a PTW file begins with a header of at least {} bytes, but the file has "
                    "{}; copy it again "
                    "from its source.",
                    path.string(), smallest_header, file.size()));
  const std::string head = file.bytes(0, smallest_header);
  const auto u32 = [&](std::size_t at) {
    return std::uint64_t{number_at<std::uint32_t>(head, at, little)};
  };
  const auto u16 = [&](std::size_t at) {
    return std::uint64_t{number_at<std::uint16_t>(head, at, little)};
  };
  const auto f32 = [&](std::size_t at) { return decimal(number_at<float>(head, at, little)); };

  const std::uint64_t main_header = u32(11), frame_header = u32(15), words = u32(23),
                      frames = u32(27);
  const std::uint64_t width = u16(377), height = u16(379);
  const std::uint64_t bits = u16(381) >= 1 && u16(381) <= 16 ? u16(381) : 16;
  const std::uint64_t room = file.size() > main_header ? file.size() - main_header : 0;
  const std::uint64_t stride =
      frame_stride(room, frames, frame_header, width * height, u32(19), words);
  if (width == 0 || height == 0 || stride == 0 || main_header < smallest_header)
    throw InputError(path.string() +
                     ": the PTW header contradicts itself: " + std::to_string(width) + " x " +
                     std::to_string(height) + " pixels in frames of " + std::to_string(words) +
                     " 16-bit words; the file is damaged or of an unknown kind.");
  const std::uint64_t held = room / stride;

  RecordingHeader header;
  header.path = path;
  header.width = width;
  header.height = height;
  // A recording that was broken off may say 0 frames or too few: what is there counts.
  header.frames = held;
  header.frames_lost = frames > held ? frames - held : 0;
  if (held > frames)
    header.notes.push_back(fmt::format(
        "The header announces {} frames, but {} whole frames are there; all of them are read.",
        frames, held));
  const double period = f32(403);
  if (std::isfinite(period) && period > 0) header.frame_rate = 1 / period;
  if (std::isfinite(f32(407)) && f32(407) > 0) header.integration_time = f32(407);
  header.saturation = std::ldexp(1.0, static_cast<int>(bits)) - 1;
  header.under_range = 0;
  header.calibration = {{"emissivity", f32(141)},
                        {"ambient_temperature_K", f32(145)},
                        {"bits", static_cast<double>(bits)}};

  if (held > 1 && frame_header >= stamp_end && header.frame_rate > 0) {
    const double elapsed =
        time_of_day(file, main_header + (held - 1) * stride) - time_of_day(file, main_header);
    const double announced = static_cast<double>(held - 1) / header.frame_rate;
    // The stamps count hundredths of a second; a negative difference is midnight.
    if (elapsed >= 0 && std::abs(elapsed - announced) > 0.05 + 0.02 * announced)
      header.notes.push_back(
          fmt::format("The header's frame period is {} s, but the clock in the frames advances by "
                      "{:.4f} s a frame; "
                      "times and speeds follow the header, so check which one is right.",
                      period, elapsed / static_cast<double>(held - 1)));
  }

  if (u16(277) != 0)
    header.notes.push_back(
        "The camera's software rescaled the values of this file to a scale of its own; they count "
        "as a bare signal.");
  const bool lock_in = held > 0 && has_lock_in_row(file, main_header + frame_header, width);
  if (lock_in)
    header.notes.push_back(
        "The first row of every frame holds the lock-in reference and no pixels; it is marked as "
        "dead.");
  return {header, [file, main_header, frame_header, stride, lock_in, width](std::size_t index,
                                                                            Frame& frame) {
            widen(file.bytes(main_header + index * stride + frame_header, 2 * frame.values.size()),
                  little, frame.values);
            if (lock_in)
              std::fill_n(frame.values.begin(), width, std::numeric_limits<float>::quiet_NaN());
          }};
}

}  // namespace meltproof::imaging

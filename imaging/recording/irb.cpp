// SPDX-License-Identifier: GPL-3.0-or-later
// The layout is not published by its maker; these are the facts that reverse engineering agrees on.
// All little endian. The file begins with FF "IRB" 0, two names of 8 bytes, u32, then at 25 the
// place of the directory and at 29 its number of entries. An entry has 32 bytes: u32 type, u32, u32
// frame, u32 place, u32 length. Type 1 is a frame; type 4 points to two more entries, so that a
// sequence is a chain; the others (preview 2, text 3, sound 7) hold no signal. A frame has u16
// bytes a pixel, u16 compression, u16 width, u16 height; f32 at 24 emissivity, 28 distance in m, 32
// and 40 the temperatures of surroundings and air in K, 48 wavelength in um; at 60 a table of 256
// temperatures in K; at 1176 and 1180 the calibrated range in K; at 1624 the time in days (f64) and
// at 1632 milliseconds (u32); at 1728 the pixels. A pixel has a low and a high byte; the high one
// is a place in the table, the low one goes on to the next in 256 steps. Without compression they
// alternate, low first. With compression 1 all low bytes come first, then pairs of a run length and
// a high byte.
#include "imaging/recording/irb.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "imaging/recording/bytes.hpp"

namespace meltproof::imaging {
namespace {

constexpr auto little = std::endian::little;
constexpr std::uint64_t file_header = 64, entry_size = 32, frame_header = 1728;
constexpr std::size_t table_place = 60, table_size = 256;
constexpr std::uint32_t frame_entry = 1, chain_entry = 4;

struct Place {
  std::uint64_t start = 0, length = 0;
};

/// The frames of a file, in order; where the file is cut off, the lost one is counted.
struct Frames {
  std::vector<Place> places;
  std::size_t lost = 0;
};

Frames find_frames(const ByteFile& file) {
  const std::string head = file.bytes(0, file_header);
  Frames frames;
  struct Directory {
    std::uint64_t place, entries;
  };
  std::vector<Directory> open = {
      {number_at<std::uint32_t>(head, 25, little), number_at<std::uint32_t>(head, 29, little)}};
  std::set<std::uint64_t> seen;  // a damaged chain may lead back
  while (!open.empty()) {
    const auto [place, entries] = open.back();
    open.pop_back();
    if (!seen.insert(place).second) {
      throw InputError(
          fmt::format("{}: the directory at byte {} is reached twice; the file is damaged.",
                      file.path().string(), place));
    }
    for (std::uint64_t i = 0; i < entries; ++i) {
      const std::uint64_t at = place + i * entry_size;
      if (at > file.size() || file.size() - at < entry_size) {
        ++frames.lost;  // the chain was about to go on
        return frames;
      }
      const std::string entry = file.bytes(at, entry_size);
      const auto u32 = [&](std::size_t offset) {
        return number_at<std::uint32_t>(entry, offset, little);
      };
      const Place target{u32(12), u32(16)};
      // A sequence that ended as it should may point to the end of the file.
      if (u32(0) == chain_entry && target.start != 0 && target.start != file.size())
        open.push_back({target.start, 2});
      if (u32(0) != frame_entry) continue;
      if (target.start > file.size() || target.length > file.size() - target.start)
        ++frames.lost;
      else
        frames.places.push_back(target);
    }
  }
  return frames;
}

[[noreturn]] void refuse(const ByteFile& file, std::size_t frame, const std::string& what) {
  throw InputError(fmt::format("{}: frame {} {}", file.path().string(), frame, what));
}

/// The head of a frame, checked.
struct Head {
  std::string bytes;
  std::size_t width = 0, height = 0;
  bool compressed = false;
  double f32(std::size_t at) const { return decimal(number_at<float>(bytes, at, little)); }
  double days() const { return number_at<double>(bytes, 1624, little); }
  std::uint32_t milliseconds() const { return number_at<std::uint32_t>(bytes, 1632, little); }
};

/// s from the first frame on. Some cameras count milliseconds on and on, some within a second.
double elapsed(const Head& first, const Head& here, bool counts_on) {
  const double milliseconds =
      static_cast<double>(here.milliseconds()) - static_cast<double>(first.milliseconds());
  return (counts_on ? 0 : (here.days() - first.days()) * 86400) + milliseconds / 1000;
}

Head read_head(const ByteFile& file, const Place& place, std::size_t frame) {
  if (place.length < frame_header)
    refuse(file, frame,
           fmt::format("has {} bytes, expected at least {}; the file is damaged.", place.length,
                       frame_header));
  Head head{file.bytes(place.start, frame_header), 0, 0, false};
  const auto u16 = [&](std::size_t at) {
    return std::uint64_t{number_at<std::uint16_t>(head.bytes, at, little)};
  };
  head.width = u16(4);
  head.height = u16(6);
  head.compressed = u16(2) == 1;
  if (u16(2) > 1)
    refuse(file, frame,
           fmt::format("is compressed in a way (kind {}) that is not publicly known; export the "
                       "recording from IRBIS as a TIFF stack, as CSV or uncompressed.",
                       u16(2)));
  const std::uint64_t pixels = u16(4) * u16(6), stored = place.length - frame_header;
  if (u16(0) != 2 || (head.compressed ? stored < pixels : stored < 2 * pixels))
    refuse(file, frame,
           fmt::format("says {} x {} pixels of {} bytes, but holds {} bytes of pixels; the file is "
                       "damaged or of an unknown kind.",
                       u16(4), u16(6), u16(0), stored));
  return head;
}

/// The place in the table, in steps of 1/256, of every pixel: its raw 16-bit value.
void read_raw(const ByteFile& file, const Place& place, const Head& head, std::size_t frame,
              std::vector<float>& raw) {
  if (!head.compressed)
    return widen(file.bytes(place.start + frame_header, 2 * raw.size()), little, raw);
  const std::string b = file.bytes(place.start + frame_header, place.length - frame_header);
  const auto byte = [&](std::size_t i) { return unsigned{static_cast<unsigned char>(b[i])}; };
  std::size_t run = raw.size(), pixel = 0;  // the runs begin behind the low bytes
  while (pixel < raw.size()) {
    if (b.size() - run < 2 || byte(run) == 0)
      refuse(file, frame,
             fmt::format("is compressed, but its runs end after {} of {} pixels; the file is "
                         "damaged.",
                         pixel, raw.size()));
    const std::size_t end = std::min(raw.size(), pixel + byte(run));
    for (; pixel < end; ++pixel) raw[pixel] = static_cast<float>(byte(pixel) | byte(run + 1) << 8);
    run += 2;
  }
}

/// K of a raw value; the last place of the table has no next one to go on to.
float temperature(const std::array<float, table_size>& table, float raw) {
  const auto value = static_cast<unsigned>(raw);
  const unsigned high = value >> 8, low = value & 0xFF;
  const float from = table[high];
  if (low == 0) return from > 0 ? from : std::numeric_limits<float>::quiet_NaN();
  if (high + 1 == table_size) return std::numeric_limits<float>::quiet_NaN();
  const float kelvin = from + (table[high + 1] - from) * static_cast<float>(low) / 256;
  return kelvin > 0 ? kelvin : std::numeric_limits<float>::quiet_NaN();
}

void describe(const Head& first, RecordingHeader& header) {
  header.quantity = SignalQuantity::temperature;
  header.unit = std::string("K");  // a bare "K" meets a false warning of GCC 12
  header.calibration = {{"emissivity", first.f32(24)},
                        {"distance_m", first.f32(28)},
                        {"ambient_temperature_K", first.f32(32)},
                        {"atmospheric_temperature_K", first.f32(40)},
                        {"wavelength_um", first.f32(48)}};
  const double low = first.f32(1176), high = first.f32(1180);
  if (low > 0 && high > low) {
    header.under_range = low;
    header.saturation = high;
  }
}

}  // namespace

bool is_irb(std::string_view first_bytes) {
  return first_bytes.starts_with(std::string_view("\xFFIRB\0", 5));
}

Recording open_irb(const std::filesystem::path& path) {
  const ByteFile file(path);
  const Frames frames = find_frames(file);
  RecordingHeader header;
  header.path = path;
  header.frames = frames.places.size();
  header.frames_lost = frames.lost;
  if (frames.places.empty()) return {header, nullptr};
  const Head first = read_head(file, frames.places[0], 0);
  header.width = first.width;
  header.height = first.height;
  describe(first, header);
  bool counts_on = false;
  if (const std::size_t last = header.frames - 1; last > 0) {
    const Head end = read_head(file, frames.places[last], last);
    counts_on = end.milliseconds() >= 1000;
    const double seconds = elapsed(first, end, counts_on);
    if (std::isfinite(seconds) && seconds > 0)
      header.frame_rate = static_cast<double>(last) / seconds;
    else
      header.notes.push_back("The frames carry no advancing time, so the frame rate is unknown.");
  }
  return {header, [file, places = frames.places, header, first, counts_on](std::size_t index,
                                                                           Frame& frame) {
            const Head head = read_head(file, places[index], index);
            if (head.width != header.width || head.height != header.height)
              refuse(file, index, "has another size than the first; split the recording by size.");
            std::array<float, table_size> table{};
            for (std::size_t i = 0; i < table_size; ++i)
              table[i] = number_at<float>(head.bytes, table_place + 4 * i, little);
            frame.counts.resize(frame.values.size());
            read_raw(file, places[index], head, index, frame.counts);
            std::transform(frame.counts.begin(), frame.counts.end(), frame.values.begin(),
                           [&](float raw) { return temperature(table, raw); });
            const double time = elapsed(first, head, counts_on);
            if (header.frame_rate > 0 && std::isfinite(time)) frame.time = time;
          }};
}

}  // namespace meltproof::imaging

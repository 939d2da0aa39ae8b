// SPDX-License-Identifier: GPL-3.0-or-later
// Layout: lines "key value", among them xPixls, yPixls (size), DaType (type of a pixel), NumDPs
// (frames), ADBits, Include (name of the .inc file); a line saf_padding that fills up; a line DATA;
// then frames without gaps, little endian. NumDPs can disagree with the size of the file.
#include "imaging/recording/sfmov.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "base/error.hpp"
#include "imaging/recording/bytes.hpp"
#include "imaging/recording/sfmov_include.hpp"

namespace meltproof::imaging {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t longest_header = 1 << 20, longest_include = 1 << 20;

enum class PixelType { u16, i16, f32 };

struct Layout {
  std::map<std::string, std::string> keys;
  std::uint64_t start = 0;  // of the first frame
  PixelType type = PixelType::u16;
};

/// Where the line DATA ends, or 0.
std::uint64_t data_start(const std::string& head) {
  for (std::size_t at = head.find("\nDATA"); at != std::string::npos;
       at = head.find("\nDATA", at + 1)) {
    const auto rest = std::string_view(head).substr(at + 5);
    if (rest.starts_with("\r\n")) return at + 7;
    if (rest.starts_with("\n")) return at + 6;
  }
  return 0;
}

std::uint64_t whole_number(const fs::path& path, const Layout& layout, const std::string& key) {
  const auto found = layout.keys.find(key);
  const std::string text = found == layout.keys.end() ? "" : found->second;
  std::uint64_t value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size())
    throw InputError(fmt::format(
        "{}: the SFMOV header says {} \"{}\", expected a whole number; the file is damaged.",
        path.string(), key, text.substr(0, 40)));
  return value;
}

Layout read_layout(const ByteFile& file) {
  const std::string head = file.beginning(longest_header);
  Layout layout;
  layout.keys = sfmov_keys(head);
  layout.start = data_start(head);
  if (layout.start == 0)
    throw InputError(file.path().string() +
                     ": the SFMOV header has no line DATA, behind which the frames begin; the file "
                     "is cut off or damaged, copy it again from its source.");
  std::string type = layout.keys.contains("DaType") ? layout.keys.at("DaType") : "";
  std::transform(type.begin(), type.end(), type.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (type == "flt32" || type == "float32")
    layout.type = PixelType::f32;
  else if (type == "int16")
    layout.type = PixelType::i16;
  else if (type != "uint16" && type != "word16" && type != "word")
    throw InputError(fmt::format(
        "{}: the pixels are of the type DaType \"{}\", expected UInt16, Int16 or Flt32; export the "
        "recording anew with one of them.",
        file.path().string(), type.substr(0, 40)));
  return layout;
}

/// The .inc file: the one that the header names, or the one that is named like the recording.
fs::path find_include(const fs::path& recording, const Layout& layout) {
  std::error_code error;
  std::vector<fs::path> candidates;
  if (const auto named = layout.keys.find("Include"); named != layout.keys.end()) {
    const auto slash = named->second.find_last_of("/\\");  // it may be a path of Windows
    const auto name = slash == std::string::npos ? named->second : named->second.substr(slash + 1);
    if (name.find('\0') == std::string::npos) candidates.push_back(recording.parent_path() / name);
  }
  for (const auto* extension : {".inc", ".INC"})
    candidates.push_back(fs::path(recording).replace_extension(extension));
  for (const auto& candidate : candidates)
    if (fs::is_regular_file(candidate, error)) return candidate;
  return {};
}

void apply_include(const SfmovInclude& include, RecordingHeader& header) {
  header.frame_rate = include.frame_rate;
  header.integration_time = include.integration_time;
  header.calibration.insert(include.constants.begin(), include.constants.end());
  if (include.more_presets)
    header.notes.push_back(
        "The .inc file describes several presets; integration time and calibration are those of "
        "preset 0, so a recording that alternates between presets must be split first.");
}

/// Counts that become temperatures, with the limits that they mark.
void calibrate(const SfmovCalibration& c, RecordingHeader& header) {
  header.quantity = SignalQuantity::temperature;
  header.unit = std::string("K");          // a bare "K" meets a false warning of GCC 12
  const auto limit = [&](double counts) {  // rounded as the pixels are, which it is compared with
    return static_cast<double>(static_cast<float>(c.temperature(counts)));
  };
  header.saturation = limit(c.highest_count.value_or(header.saturation));
  header.under_range = limit(c.lowest_count.value_or(0));
  if (std::isnan(header.saturation)) header.saturation = std::numeric_limits<double>::infinity();
  if (std::isnan(header.under_range)) header.under_range = -std::numeric_limits<double>::infinity();
  header.notes.push_back(
      "The temperatures are those of a black body by the .inc file's calibration: emissivity and "
      "windows are not in them.");
}

void convert(const std::string& bytes, PixelType type, std::vector<float>& into) {
  if (type == PixelType::u16) return widen(bytes, std::endian::little, into);
  for (std::size_t i = 0; i < into.size(); ++i)
    into[i] = type == PixelType::f32
                  ? number_at<float>(bytes, 4 * i, std::endian::little)
                  : static_cast<float>(number_at<std::int16_t>(bytes, 2 * i, std::endian::little));
}

}  // namespace

bool is_sfmov(std::string_view first_bytes) {
  return first_bytes.starts_with("xPixls ") ||
         first_bytes.find("\nxPixls ") != std::string_view::npos;
}

Recording open_sfmov(const fs::path& path) {
  const ByteFile file(path);
  const Layout layout = read_layout(file);
  RecordingHeader header;
  header.path = path;
  header.width = whole_number(path, layout, "xPixls");
  header.height = whole_number(path, layout, "yPixls");
  check_frame_size(header);
  const std::uint64_t stride =
      header.width * header.height * (layout.type == PixelType::f32 ? 4 : 2);
  header.frames = (file.size() - layout.start) / stride;
  if (layout.keys.contains("NumDPs")) {
    const std::uint64_t announced = whole_number(path, layout, "NumDPs");
    header.frames_lost = announced > header.frames ? announced - header.frames : 0;
    if (announced < header.frames)
      header.notes.push_back(fmt::format(
          "The header announces {} frames, but {} whole frames are there; all of them are read.",
          announced, header.frames));
  }
  if (layout.type == PixelType::f32) {
    header.notes.push_back(
        "The pixels are floating-point values of which the file does not say what they are; if "
        "they are degrees Celsius, say so with kelvin_per_count 1 K and zero_count_temperature "
        "273.15 K.");
  } else {
    const std::uint64_t bits =
        layout.keys.contains("ADBits") ? whole_number(path, layout, "ADBits") : 16;
    header.saturation = std::ldexp(1.0, static_cast<int>(bits >= 1 && bits <= 16 ? bits : 16)) - 1;
    header.under_range = 0;
  }
  std::optional<SfmovCalibration> calibration;
  if (const auto include_path = find_include(path, layout); !include_path.empty()) {
    const auto include = parse_sfmov_include(ByteFile(include_path).beginning(longest_include));
    apply_include(include, header);
    header.companions.push_back(include_path);
    if (layout.type != PixelType::f32) calibration = include.calibration;
  } else {
    header.notes.push_back(
        "There is no .inc file beside the recording, so frame rate, integration time and "
        "calibration are unknown; export it again with the recording.");
  }
  if (calibration) calibrate(*calibration, header);
  return {header, [file, layout, stride, calibration](std::size_t index, Frame& frame) {
            const std::string bytes = file.bytes(layout.start + index * stride, stride);
            if (!calibration) return convert(bytes, layout.type, frame.values);
            frame.counts.resize(frame.values.size());
            convert(bytes, layout.type, frame.counts);
            std::transform(
                frame.counts.begin(), frame.counts.end(), frame.values.begin(), [&](float counts) {
                  return static_cast<float>(calibration->temperature(static_cast<double>(counts)));
                });
          }};
}

}  // namespace meltproof::imaging

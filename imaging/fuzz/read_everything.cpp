// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/fuzz/read_everything.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <stdexcept>

#include "base/error.hpp"
#include "imaging/recording/bytes.hpp"
#include "imaging/recording/formats.hpp"
#include "imaging/recording/sfmov_include.hpp"

namespace meltproof::imaging {
namespace {

// Frames of a damaged file may be many and large; these are enough to meet every line of a reader.
constexpr std::size_t most_pixels = 1 << 16;

/// The short names and the formats that they stand for.
const std::map<std::string, std::string>& short_names() {
  static const std::map<std::string, std::string> names = {
      {"ptw", "Cedip PTW"},    {"flir", "FLIR SEQ"},    {"flir_jpeg", "FLIR JPEG"},
      {"sfmov", "FLIR SFMOV"}, {"irb", "InfraTec IRB"}, {"tiff", "TIFF"},
      {"picture", "picture"},  {"hdf5", "HDF5"},        {"matlab_7", "MATLAB 7.3"},
      {"csv", "CSV"},          {"matlab_5", "MATLAB 5"}};
  return names;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

void read_frames(const Recording& recording) {
  const auto& h = recording.header();
  if (h.width * h.height > most_pixels) return;
  Frame once, again;
  for (const std::size_t index : {std::size_t{0}, h.frames / 2, h.frames - 1}) {
    recording.read(index, once);
    recording.read(index, again);
    if (!same_bits(once.values, again.values))
      throw std::logic_error("a frame that is read twice differs");
  }
}

Outcome read_include(const std::filesystem::path& path) {
  const auto include = parse_sfmov_include(ByteFile(path).beginning(1 << 20));
  if (!include.calibration) return Outcome::refused;
  for (const double counts : {0.0, 1.0, 8191.0, 65535.0})
    static_cast<void>(include.calibration->temperature(counts));
  return Outcome::read;
}

}  // namespace

std::vector<std::string> reader_names() {
  std::vector<std::string> names = {"sfmov_include"};
  for (const auto& [name, format] : short_names()) names.push_back(name);
  return names;
}

Outcome read_everything(const std::string& reader, const std::filesystem::path& path) {
  if (reader == "sfmov_include") return read_include(path);
  const auto& name = short_names().at(reader);
  const auto& table = formats();
  const auto format =
      std::find_if(table.begin(), table.end(), [&](const Format& f) { return f.name == name; });
  if (format == table.end()) throw std::logic_error("there is no format " + name);
  try {
    if (!format->recognises(ByteFile(path).beginning(4096))) return Outcome::foreign;
    read_frames(format->open(path, {}));
    return Outcome::read;
  } catch (const InputError& error) {
    if (std::strlen(error.what()) < 20) throw std::logic_error("a refusal is no sentence");
    return Outcome::refused;
  }
}

}  // namespace meltproof::imaging

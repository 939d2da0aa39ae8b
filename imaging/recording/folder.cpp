// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/folder.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/provenance.hpp"
#include "imaging/recording/formats.hpp"

namespace meltproof::imaging {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The digits that begin at `at`, without leading zeros.
std::string digits(const std::string& text, std::size_t& at) {
  const std::size_t begin = at;
  while (at < text.size() && is_digit(text[at])) ++at;
  const std::size_t first = std::min(text.find_first_not_of('0', begin), at);
  return text.substr(first, at - first);
}

/// The parts of the recording, of the one extension of a known format that the folder holds.
std::vector<fs::path> list_parts(const fs::path& folder) {
  std::set<std::string> known;
  for (const auto& format : formats())
    known.insert(format.extensions.begin(), format.extensions.end());
  std::map<std::string, std::vector<fs::path>> found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    std::string extension = entry.path().extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (entry.is_regular_file() && known.contains(extension))
      found[extension].push_back(entry.path());
  }
  if (found.empty())
    throw InputError(folder.string() +
                     ": the folder holds no file of a format that can be read; give the folder "
                     "with the frames, or one recording.");
  if (found.size() > 1)
    throw InputError(fmt::format(
        "{}: the folder holds {} and {} files, and only one kind can be the frames; move the "
        "others elsewhere.",
        folder.string(), found.begin()->first, std::next(found.begin())->first));
  auto files = std::move(found.begin()->second);
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return natural_order(a.filename().string(), b.filename().string());
  });
  return files;
}

/// Which file holds a frame, and which frame of it.
struct Place {
  std::size_t file = 0, frame = 0;
};

/// Keeps the file open that was read last: thousands cannot be open at once.
struct Opened {
  std::size_t file = 0;
  std::optional<Recording> recording;
};

}  // namespace

bool natural_order(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string x = digits(a, i), y = digits(b, j);
      if (x.size() != y.size()) return x.size() < y.size();
      if (x != y) return x < y;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  if ((i < a.size()) != (j < b.size())) return j < b.size();
  return a < b;  // 01 and 1: some order, but always the same
}

Recording open_folder(const fs::path& path, const ReadOptions& options) {
  const auto files = list_parts(path);
  RecordingHeader header;
  std::vector<Place> places;
  std::string checksums;
  std::size_t frames_lost = 0;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto part = open_part(files[i], options).header();
    if (i == 0) header = part;
    if (part.width != header.width || part.height != header.height ||
        part.quantity != header.quantity || part.unit != header.unit)
      throw InputError(fmt::format(
          "{}: its frames are {} x {} pixels of {}, but those of {} are {} x {} of {}; the frames "
          "of a recording are alike, so move one kind elsewhere.",
          files[i].string(), part.width, part.height, quantity_name(part.quantity),
          files[0].filename().string(), header.width, header.height,
          quantity_name(header.quantity)));
    for (std::size_t frame = 0; frame < part.frames; ++frame) places.push_back({i, frame});
    frames_lost += part.frames_lost;
    checksums += sha256_file(files[i]) + " " + files[i].filename().string() + "\n";
  }
  header.path = path;
  header.frames = places.size();
  header.frames_lost = frames_lost;
  header.sha256 = sha256_text(checksums);
  header.companions = files;
  if (places.size() == files.size()) header.frame_rate = 0;
  header.notes.push_back(fmt::format(
      "The frames are those of {} files in the order of their names, numbers as numbers, and are "
      "taken as evenly spaced in time.",
      files.size()));
  return {header, [files, places, options, rate = header.frame_rate,
                   opened = std::make_shared<Opened>()](std::size_t index, Frame& frame) {
            const auto place = places[index];
            if (!opened->recording || opened->file != place.file) {
              opened->recording = open_part(files[place.file], options);
              opened->file = place.file;
            }
            opened->recording->read(place.frame, frame);
            frame.index = index;
            frame.time = rate > 0 ? static_cast<double>(index) / rate : 0;
          }};
}

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/formats.hpp"

#include <algorithm>
#include <cctype>

#include "base/error.hpp"
#include "base/provenance.hpp"
#include "imaging/recording/bytes.hpp"
#include "imaging/recording/flir.hpp"
#include "imaging/recording/hdf5.hpp"
#include "imaging/recording/picture.hpp"
#include "imaging/recording/ptw.hpp"
#include "imaging/recording/tiff.hpp"

namespace meltproof::imaging {

const std::vector<Format>& formats() {
  static const std::vector<Format> table = {
      {"Cedip PTW", {".ptw"}, "the letters CED", is_ptw, open_ptw},
      {"FLIR SEQ", {".seq", ".fff"}, "the letters FFF", is_flir, open_flir},
      {"TIFF", {".tif", ".tiff"}, "II or MM and a version", is_tiff, open_tiff},
      {"picture", {".bmp", ".png"}, "BM or the mark of PNG", is_picture, open_picture},
      {"HDF5", {".h5", ".hdf5"}, "the mark of HDF5", is_hdf5, open_hdf5},
  };
  return table;
}

namespace {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

std::string all_extensions() {
  std::string list;
  for (const auto& format : formats())
    for (const auto& extension : format.extensions) list += (list.empty() ? "" : ", ") + extension;
  return list;
}

/// What the content is, for a person.
std::string describe(std::string_view first_bytes) {
  if (first_bytes.empty()) return "the file is empty";
  const bool text = std::all_of(first_bytes.begin(), first_bytes.end(), [](unsigned char c) {
    return c == '\n' || c == '\r' || c == '\t' || c >= 0x20;
  });
  if (!text) return "its content is of an unknown kind";
  const auto line =
      first_bytes.substr(0, std::min<std::size_t>(first_bytes.find_first_of("\r\n"), 24));
  return "its content is text (it begins with \"" + std::string(line) + "\")";
}

[[noreturn]] void refuse(const std::filesystem::path& path, std::string_view first_bytes) {
  const std::string extension = lower_extension(path);
  const std::string found = path.string() + ": " + describe(first_bytes);
  if (extension == ".ats")
    throw InputError(path.string() +
                     ": the ATS format is closed and cannot be read; export the recording from the "
                     "camera's software as a 16-bit TIFF stack.");
  for (const auto& format : formats())
    if (std::find(format.extensions.begin(), format.extensions.end(), extension) !=
        format.extensions.end())
      throw InputError(found + ", but a file named " + extension + " should begin with " +
                       format.beginning + " (" + format.name +
                       "); give the recording as the camera wrote it.");
  throw InputError(found + ", which is no recording that can be read; give one of " +
                   all_extensions() + ".");
}

}  // namespace

Recording open_recording(const std::filesystem::path& path) {
  std::string first_bytes;
  {
    const ByteFile file(path);
    first_bytes = file.bytes(0, std::min<std::uint64_t>(64, file.size()));
  }
  for (const auto& format : formats()) {
    if (!format.recognises(first_bytes)) continue;
    Recording recording = format.open(path);
    recording.header().format = format.name;
    recording.header().sha256 = sha256_file(path);
    return recording;
  }
  refuse(path, first_bytes);
}

}  // namespace meltproof::imaging

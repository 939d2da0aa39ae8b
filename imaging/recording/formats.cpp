// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/formats.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/provenance.hpp"
#include "imaging/recording/bytes.hpp"
#include "imaging/recording/csv.hpp"
#include "imaging/recording/flir.hpp"
#include "imaging/recording/flir_jpeg.hpp"
#include "imaging/recording/folder.hpp"
#include "imaging/recording/hdf5.hpp"
#include "imaging/recording/irb.hpp"
#include "imaging/recording/matlab.hpp"
#include "imaging/recording/picture.hpp"
#include "imaging/recording/ptw.hpp"
#include "imaging/recording/sfmov.hpp"
#include "imaging/recording/tiff.hpp"

namespace meltproof::imaging {

namespace {

/// A reader that has nothing to ask the user.
auto plain(Recording (*open)(const std::filesystem::path&)) {
  return [open](const std::filesystem::path& path, const ReadOptions&) { return open(path); };
}

}  // namespace

const std::vector<Format>& formats() {
  // Text comes last: what another format recognises is more than rows of numbers.
  static const std::vector<Format> table = {
      {"Cedip PTW", {".ptw"}, "the letters CED", is_ptw, plain(open_ptw)},
      {"FLIR SEQ", {".seq", ".fff", ".csq"}, "the letters FFF", is_flir, plain(open_flir)},
      {"FLIR JPEG", {".jpg", ".jpeg"}, "the mark of JPEG", is_flir_jpeg, plain(open_flir_jpeg)},
      {"FLIR SFMOV", {".sfmov"}, "a text with the key xPixls", is_sfmov, plain(open_sfmov)},
      {"InfraTec IRB", {".irb"}, "the letters IRB", is_irb, plain(open_irb)},
      {"TIFF", {".tif", ".tiff"}, "II or MM and a version", is_tiff, plain(open_tiff)},
      {"picture", {".bmp", ".png"}, "BM or the mark of PNG", is_picture, plain(open_picture)},
      {"HDF5", {".h5", ".hdf5"}, "the mark of HDF5", is_hdf5, open_hdf5},
      {"MATLAB 7.3", {".mat"}, "the words MATLAB 7.3", is_matlab_7, open_matlab_7},
      {"MATLAB 5", {".mat"}, "the words MATLAB 5.0", is_matlab_5, open_matlab_5},
      {"CSV", {".csv", ".asc", ".txt"}, "text with rows of numbers", is_csv, open_csv},
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
    for (const auto& extension : format.extensions) {
      if (list.find(extension) != std::string::npos) continue;  // two formats share .mat
      list += list.empty() ? "" : ", ";
      list += extension;
    }
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
                     "camera's software as SFMOV with its .inc file, as a 16-bit TIFF stack or as "
                     "CSV.");
  for (const auto& format : formats())
    if (std::find(format.extensions.begin(), format.extensions.end(), extension) !=
        format.extensions.end())
      throw InputError(fmt::format(
          "{}, but a file named {} should begin with {} ({}); give the recording as the camera "
          "wrote it.",
          found, extension, format.beginning, format.name));
  throw InputError(found + ", which is no recording that can be read; give one of " +
                   all_extensions() + ".");
}

}  // namespace

Recording open_part(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string first_bytes = ByteFile(path).beginning(4096);
  for (const auto& format : formats()) {
    if (!format.recognises(first_bytes)) continue;
    Recording recording = format.open(path, options);
    recording.header().format = format.name;
    return recording;
  }
  refuse(path, first_bytes);
}

Recording open_recording(const std::filesystem::path& path, const ReadOptions& options) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return open_folder(path, options);
  Recording recording = open_part(path, options);
  recording.header().sha256 = sha256_file(path);
  return recording;
}

}  // namespace meltproof::imaging

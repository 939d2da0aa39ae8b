// SPDX-License-Identifier: GPL-3.0-or-later
// The one table of camera formats, and how a file finds its reader.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "imaging/recording/recording.hpp"

namespace meltproof::imaging {

/// A file format: one header and source pair, and one line in formats().
struct Format {
  std::string name;                     ///< "Cedip PTW"
  std::vector<std::string> extensions;  ///< ".ptw", lower case
  std::string beginning;                ///< what its files begin with, in words, for messages
  /// Whether these first bytes (up to 64) are of this format.
  bool (*recognises)(std::string_view first_bytes);
  Recording (*open)(const std::filesystem::path& path);
};

/// Every format that can be read, in the order in which they are tried.
const std::vector<Format>& formats();

/// Opens a recording with the reader that recognises its content; the extension is only used to say
/// what was expected. Adds the SHA-256 of the file.
/// @throws InputError if the file is missing, no format recognises it, it is damaged, or it ends
///         before its first frame is whole.
Recording open_recording(const std::filesystem::path& path);

}  // namespace meltproof::imaging

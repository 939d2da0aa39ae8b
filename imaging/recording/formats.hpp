// SPDX-License-Identifier: GPL-3.0-or-later
// The one table of camera formats, and how a file finds its reader.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "imaging/recording/options.hpp"
#include "imaging/recording/recording.hpp"

namespace meltproof::imaging {

/// A file format: one header and source pair, and one line in formats().
struct Format {
  std::string name;                     ///< "Cedip PTW"
  std::vector<std::string> extensions;  ///< ".ptw", lower case
  std::string beginning;                ///< what its files begin with, in words, for messages
  /// Whether these first bytes (up to 4096) are of this format.
  bool (*recognises)(std::string_view first_bytes);
  std::function<Recording(const std::filesystem::path& path, const ReadOptions& options)> open;
};

/// Every format that can be read, in the order in which they are tried.
const std::vector<Format>& formats();

/// Opens a recording with the reader that recognises its content; the extension is only used to say
/// what was expected. A folder is a recording whose files are its frames, see folder.hpp. Adds the
/// SHA-256 of the file, or of the names and checksums of a folder's files.
/// @throws InputError if the file is missing, no format recognises it, it is damaged, or it ends
///         before its first frame is whole.
Recording open_recording(const std::filesystem::path& path, const ReadOptions& options = {});

/// The same for one file, without the checksum: for a file that is a part of a recording.
Recording open_part(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace meltproof::imaging

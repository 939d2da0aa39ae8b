// SPDX-License-Identifier: GPL-3.0-or-later
// What fuzzing asks of a reader: whatever the bytes are, a recording or a sentence.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace meltproof::imaging {

/// The readers by short names that fit a folder: "ptw", "flir", and so on, and "sfmov_include" for
/// the text beside an SFMOV.
std::vector<std::string> reader_names();

/// What came of a file.
enum class Outcome {
  foreign,  ///< the reader does not recognise it
  refused,  ///< with a sentence
  read,     ///< as frames
};

/// Opens a file with one reader and reads its first, a middle and its last frame, twice.
/// @throws anything but InputError, which is a fault of the reader; also std::logic_error if two
///         readings differ or a refusal is no sentence.
Outcome read_everything(const std::string& reader, const std::filesystem::path& path);

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
// The table of formats that EDS programs write. A new reader is one pair of files and one line.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "validation/eds/element_map.hpp"
#include "validation/eds/line_scan.hpp"
#include "validation/eds/spectrum.hpp"

namespace meltproof::validation {

/// What a file of an EDS program holds: at least one of these.
struct EdsExport {
  std::string format;
  std::optional<LineScan> line;
  std::optional<ElementMap> map;
  std::optional<Spectrum> spectrum;
};

struct EdsFormat {
  std::string name;
  std::string extensions;  ///< usual ones, for messages: the content decides
  bool (*recognises)(std::string_view first_bytes);
  EdsExport (*read)(const std::filesystem::path& path);
};

/// Asked in this order.
const std::vector<EdsFormat>& eds_formats();

/// Reads a file by its content. @throws InputError if no format fits, or as that format's reader.
EdsExport read_eds_export(const std::filesystem::path& path);

/// The files that a measurement at `path` was read from: itself, the spectra of a folder or list,
/// the maps of a description. Empty for an empty path.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& path);

}  // namespace meltproof::validation

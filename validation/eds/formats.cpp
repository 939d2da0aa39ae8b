// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/formats.hpp"

#include <fstream>

#include <fmt/format.h>

#include "base/error.hpp"
#include "validation/eds/csv_export.hpp"
#include "validation/eds/h5oina.hpp"
#include "validation/eds/msa.hpp"
#include "validation/eds/points.hpp"
#include "validation/eds/spx.hpp"
#include "validation/eds/tiff_layer.hpp"

namespace meltproof::validation {
namespace {

using Path = std::filesystem::path;

EdsExport of(Spectrum spectrum) {
  EdsExport found;
  found.spectrum = std::move(spectrum);
  return found;
}
EdsExport of(ElementMap map) {
  EdsExport found;
  found.map = std::move(map);
  return found;
}
EdsExport of(LineScan line) {
  EdsExport found;
  found.line = std::move(line);
  return found;
}

EdsExport from_msa(const Path& path) { return of(read_msa(path)); }
EdsExport from_spx(const Path& path) {
  auto content = read_spx(path);
  EdsExport found = of(std::move(content.spectrum));
  if (content.composition) {
    found.line = read_single_point(path);
  }
  return found;
}
EdsExport from_h5oina(const Path& path) {
  return std::visit([](auto&& content) { return of(std::move(content)); }, read_h5oina(path));
}
EdsExport from_tiff(const Path& path) {
  throw InputError(fmt::format(
      "{}: a TIFF says neither its element nor its scale: describe the maps in a small TOML file "
      "and give that; --help shows one.",
      path.string()));
}
EdsExport from_description(const Path& path) { return of(read_described_map(path)); }
EdsExport from_points(const Path& path) { return of(read_point_list(path)); }
EdsExport from_csv(const Path& path) { return of(read_csv_export(path)); }

std::string beginning(const Path& path, std::size_t length) {
  std::ifstream in(path, std::ios::binary);
  if (!in || !std::filesystem::is_regular_file(path)) {
    throw InputError(
        fmt::format("{}: there is no such file, or it cannot be read.", path.string()));
  }
  std::string bytes(length, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(length));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

}  // namespace

const std::vector<EdsFormat>& eds_formats() {
  static const std::vector<EdsFormat> table = {
      {"H5OINA", ".h5oina", is_h5oina, from_h5oina},
      {"TIFF", ".tif", is_tiff, from_tiff},
      {"Bruker SPX", ".spx", is_spx, from_spx},
      {"EMSA/MAS", ".msa, .emsa", is_msa, from_msa},
      {"map description", ".toml", is_map_description, from_description},
      {"list of spectra", ".csv", is_point_list, from_points},
      {"CSV export", ".csv, .txt, .tsv", is_csv_export, from_csv},
  };
  return table;
}

EdsExport read_eds_export(const Path& path) {
  const std::string first_bytes = beginning(path, 4096);
  for (const auto& format : eds_formats()) {
    if (format.recognises(first_bytes)) {
      EdsExport found = format.read(path);
      found.format = format.name;
      if (found.line) {
        found.line->format = format.name;
      }
      return found;
    }
  }
  std::string known;
  for (const auto& format : eds_formats()) {
    known += (known.empty() ? "" : ", ") + format.name;
  }
  throw InputError(fmt::format(
      "{}: {}: expected one of {}.", path.string(),
      first_bytes.empty() ? "the file is empty" : "its content is of an unknown kind, no text",
      known));
}

LineScan read_line_scan(const Path& path, const ScanOptions& options) {
  if (std::filesystem::is_directory(path)) {
    if (!options.point_spacing) {
      throw InputError(fmt::format(
          "{}: how far apart were the spectra of this folder taken? Give their distance "
          "(--point-spacing), or a list \"file,position [um]\" instead of the folder.",
          path.string()));
    }
    LineScan scan = read_point_folder(path, *options.point_spacing);
    scan.format = "folder of spectra";
    return scan;
  }
  EdsExport found = read_eds_export(path);
  if (found.map) {
    if (!options.map_line) {
      throw InputError(fmt::format(
          "{}: it is a map of {} x {} pixels of {:.4g} um: say along which line (--map-start, "
          "--map-end).",
          path.string(), found.map->width, found.map->height, 1e6 * found.map->pixel_x));
    }
    LineScan scan = sample_map(*found.map, *options.map_line);
    scan.format = found.format;
    return scan;
  }
  if (options.map_line) {
    throw InputError(
        fmt::format("{}: it is no map, so no line is laid through it.", path.string()));
  }
  if (!found.line) {
    throw InputError(fmt::format(
        "{}: it holds {}, not a composition: --spectrum prints what is in it.", path.string(),
        found.spectrum && found.spectrum->along_a_line ? "intensities along a line"
                                                       : "a spectrum"));
  }
  return *found.line;
}

std::vector<Path> files_of(const Path& path) {
  if (path.empty()) {
    return {};
  }
  if (std::filesystem::is_directory(path)) {
    return spectra_of_folder(path);
  }
  std::vector<Path> files = {path};
  const EdsExport found = read_eds_export(path);
  for (const auto& more : {found.map ? found.map->sources : std::vector<Path>{},
                           found.line ? found.line->sources : std::vector<Path>{}}) {
    files.insert(files.end(), more.begin(), more.end());
  }
  return files;
}

}  // namespace meltproof::validation

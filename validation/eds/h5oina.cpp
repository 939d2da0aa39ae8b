// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/h5oina.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "base/artifact.hpp"
#include "base/error.hpp"
#include "validation/eds/elements.hpp"

namespace meltproof::validation {
namespace {

constexpr double most_cells = 1 << 26;

/// The first group <slice>/EDS or, with several detectors, <slice>/EDS1.
std::string find_technique(const ArtifactReader& file) {
  for (const auto& slice : file.names()) {
    for (const char* technique : {"/EDS", "/EDS1"}) {
      if (file.has(slice + technique) && file.has(slice + technique + "/Data") &&
          file.has(slice + technique + "/Header")) {
        return slice + technique;
      }
    }
  }
  throw InputError(fmt::format(
      "{}: an HDF5 file without EDS data: expected an export of AZtec with a group 1/EDS. An "
      "HDF5 map of another program is read through a description, see --help.",
      file.path().string()));
}

/// One number, which is stored as an array of one.
double number(const ArtifactReader& file, const std::string& name) {
  for (const auto length : file.shape(name)) {
    if (length != 1) {
      throw InputError(fmt::format("{}: {} is no single number: the file is damaged.",
                                   file.path().string(), name));
    }
  }
  return file.scalar(name);
}

struct Grid {
  std::size_t columns = 0, rows = 0;
  double step_x = 0, step_y = 0;  // m
};

Grid read_grid(const ArtifactReader& file, const std::string& header) {
  const double columns = number(file, header + "X Cells"), rows = number(file, header + "Y Cells");
  Grid grid;
  grid.step_x = 1e-6 * number(file, header + "X Step");
  grid.step_y = 1e-6 * number(file, header + "Y Step");
  if (!(columns >= 1 && rows >= 1 && columns * rows <= most_cells && grid.step_x > 0 &&
        (rows == 1 || grid.step_y > 0))) {
    throw InputError(
        fmt::format("{}: {} x {} cells in steps of {} and {} um cannot be: the file is damaged.",
                    file.path().string(), columns, rows, 1e6 * grid.step_x, 1e6 * grid.step_y));
  }
  grid.columns = static_cast<std::size_t>(columns);
  grid.rows = static_cast<std::size_t>(rows);
  return grid;
}

/// One value for each cell, times `factor`.
std::vector<double> read_cells(const ArtifactReader& file, const std::string& name,
                               const Grid& grid, double factor) {
  std::size_t count = 1;
  for (const auto length : file.shape(name)) {
    count *= length;
  }
  if (count != grid.columns * grid.rows) {
    throw InputError(fmt::format(
        "{}: {} holds {} values for {} x {} cells: the file is damaged, or of another version.",
        file.path().string(), name, count, grid.columns, grid.rows));
  }
  auto values = file.read<double>(name).values;
  for (double& value : values) {
    value *= factor;
  }
  return values;
}

/// The data set of a group that is of an element: "Al K series" or "Al Ka1"; empty if none.
std::string of_element(const ArtifactReader& file, const std::string& group,
                       const std::string& symbol) {
  if (file.has(group)) {
    for (const auto& name : file.names(group)) {
      if (element_named_in(name) == symbol && name.find(" K") != std::string::npos) {
        return group + "/" + name;
      }
    }
  }
  return "";
}

void read_counts(const ArtifactReader& file, const std::string& data, const std::string& symbol,
                 const Grid& grid, MapLayer& layer) {
  const std::string peak = of_element(file, data + "Peak Area", symbol);
  if (peak.empty() || !file.has(data + "Live Time")) {
    return;
  }
  const auto time = read_cells(file, data + "Live Time", grid, 1);
  layer.counts = read_cells(file, peak, grid, 1);
  std::transform(time.begin(), time.end(), layer.counts.begin(), layer.counts.begin(),
                 std::multiplies<>());
  const std::string window = of_element(file, data + "Window Integral", symbol);
  if (!window.empty()) {
    const auto all = read_cells(file, window, grid, 1);
    for (std::size_t i = 0; i < all.size(); ++i) {
      layer.background.push_back(std::max(0.0, all[i] * time[i] - layer.counts[i]));
    }
  }
}

LineScan line_of(const ElementMap& map, double step) {
  LineScan scan;
  scan.path = map.path;
  scan.voltage = map.voltage;
  scan.remarks = map.remarks;
  for (std::size_t i = 0; i < map.width; ++i) {
    scan.position.push_back(static_cast<double>(i) * step);
  }
  for (const auto& [symbol, layer] : map.layers) {
    scan.elements[symbol] = {layer.fraction, layer.uncertainty, layer.counts, layer.background};
  }
  check_totals(scan);
  return scan;
}

}  // namespace

bool is_h5oina(std::string_view first_bytes) {
  using namespace std::string_view_literals;
  return first_bytes.starts_with("\x89HDF\r\n\x1a\n"sv);
}

std::variant<LineScan, ElementMap> read_h5oina(const std::filesystem::path& path) {
  const ArtifactReader file(path);
  const std::string technique = find_technique(file);
  const std::string data = technique + "/Data/", header = technique + "/Header/";
  const Grid grid = read_grid(file, header);
  ElementMap map;
  map.path = path;
  map.width = grid.columns;
  map.height = grid.rows;
  map.pixel_x = grid.step_x;
  map.pixel_y = grid.rows == 1 ? grid.step_x : grid.step_y;
  if (file.has(header + "Beam Voltage")) {
    map.voltage = number(file, header + "Beam Voltage");
  }
  const std::string composition = data + "Composition";
  if (!file.has(composition)) {
    throw InputError(fmt::format(
        "{}: {} holds {} but no Composition: quantify the line or map in AZtec (QuantLine, "
        "QuantMap) and export it again. Intensities are not turned into a composition here.",
        path.string(), data, fmt::join(file.names(data), ", ")));
  }
  for (const auto& name : file.names(composition)) {
    const std::string symbol = element_named_in(name);
    if (symbol.empty()) {
      map.remarks.push_back(
          fmt::format("\"{}\" is no element that is known here: it is passed over.", name));
      continue;
    }
    MapLayer& layer = map.layers[symbol];
    layer.fraction = read_cells(file, composition + "/" + name, grid, 0.01);
    const std::string sigma = data + "Composition Sigma/" + name;
    if (file.has(sigma)) {
      layer.uncertainty = read_cells(file, sigma, grid, 0.01);
    }
    read_counts(file, data, symbol, grid, layer);
  }
  if (map.layers.empty()) {
    throw InputError(
        fmt::format("{}: {} names no element that is known here.", path.string(), composition));
  }
  if (grid.rows == 1) {
    return line_of(map, grid.step_x);
  }
  return map;
}

}  // namespace meltproof::validation

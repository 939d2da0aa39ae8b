// SPDX-License-Identifier: GPL-3.0-or-later
// A map that a TOML file describes, since a TIFF says neither its element nor its scale:
//
//   unit = "wt%"
//   pixel_size = "0.2 um"
//   [[element]]
//   symbol = "Al"
//   file = "al.tif"
//   percent_per_count = 0.01   # integers only
#include <deque>

#include <fmt/format.h>

#include "base/artifact.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/input.hpp"
#include "validation/eds/element_map.hpp"
#include "validation/eds/elements.hpp"
#include "validation/eds/tiff_layer.hpp"

namespace meltproof::validation {
namespace {

struct Described {
  std::string symbol, dataset, sigma_dataset;
  std::filesystem::path file, sigma_file;
  std::optional<double> percent_per_count;
};

Layer read_layer(const std::filesystem::path& file, const std::string& dataset) {
  if (is_tiff(read_file(file).substr(0, 4))) {
    return read_tiff_layer(file);
  }
  const ArtifactReader reader(file);
  if (dataset.empty()) {
    throw InputError(fmt::format(
        "{}: which data set is the map? Add, for example, dataset = \"maps/Al\".", file.string()));
  }
  const auto shape = reader.shape(dataset);
  const auto size = std::filesystem::file_size(file);
  if (shape.size() != 2 || shape[0] == 0 || shape[1] == 0 || shape[0] > (1u << 16) ||
      shape[1] > (1u << 16) || shape[0] * shape[1] > 2000 * size) {
    throw InputError(fmt::format("{}: the data set {} is no map: expected rows and columns.",
                                 file.string(), dataset));
  }
  return {shape[1], shape[0], reader.read<double>(dataset).values, false};
}

std::vector<double> percent(const Layer& layer, const Described& element,
                            const std::filesystem::path& file) {
  if (layer.integers && !element.percent_per_count) {
    throw InputError(fmt::format(
        "{}: it holds integers: say in the description how many percent one count is, for example "
        "percent_per_count = 0.01. A map of intensities is no map of a composition.",
        file.string()));
  }
  std::vector<double> values = layer.values;
  for (double& value : values) {
    value *= 0.01 * element.percent_per_count.value_or(1);
  }
  return values;
}

}  // namespace

bool is_map_description(std::string_view first_bytes) {
  return first_bytes.find("[[element]]") != std::string_view::npos &&
         first_bytes.find('\0') == std::string_view::npos;
}

ElementMap read_described_map(const std::filesystem::path& path) {
  ElementMap map;
  map.path = path;
  std::string unit;
  std::deque<Described> described;
  InputTable root("", "element maps of one place, each in its own TIFF or HDF5 data set");
  root.text(unit,
            {.name = "unit", .about = "of all maps", .required = true, .choices = {"wt%", "at%"}});
  root.quantity(map.pixel_x, {.name = "pixel_size",
                              .unit = "m",
                              .about = "distance of two pixels",
                              .required = true,
                              .minimum = 1e-12,
                              .maximum = 1e-2});
  root.quantity(map.voltage, {.name = "voltage", .unit = "kV", .about = "of the electron beam"});
  root.tables(
      "element", "one element's map",
      [&](std::size_t) {
        Described& d = described.emplace_back();
        InputTable table("element", "one element's map");
        table.text(d.symbol, {.name = "symbol", .about = "of the element", .required = true})
            .file(d.file, {.name = "file", .about = "TIFF or HDF5", .required = true})
            .text(d.dataset, {.name = "dataset", .about = "path of the map in an HDF5 file"})
            .quantity(d.percent_per_count,
                      {.name = "percent_per_count", .unit = "1", .about = "of maps of integers"})
            .file(d.sigma_file, {.name = "sigma_file", .about = "map of standard uncertainties"})
            .text(d.sigma_dataset, {.name = "sigma_dataset", .about = "its path in an HDF5 file"});
        return table;
      },
      true);
  Input input(std::move(root));
  input.read(path);
  map.of_atoms = unit == "at%";
  map.pixel_y = map.pixel_x;
  for (const auto& d : described) {
    if (!is_element(d.symbol)) {
      throw InputError(fmt::format("{}: symbol: \"{}\" is no element that is known here.",
                                   path.string(), d.symbol));
    }
    const Layer layer = read_layer(d.file, d.dataset);
    if (map.layers.empty()) {
      map.width = layer.width;
      map.height = layer.height;
    }
    MapLayer& into = map.layers[d.symbol];
    if (!into.fraction.empty()) {
      throw InputError(
          fmt::format("{}: there are two maps of {}: expected one.", path.string(), d.symbol));
    }
    into.fraction = percent(layer, d, d.file);
    map.sources.push_back(d.file);
    std::vector<const Layer*> sizes = {&layer};
    Layer sigma;
    if (!d.sigma_file.empty()) {
      sigma = read_layer(d.sigma_file, d.sigma_dataset);
      into.uncertainty = percent(sigma, d, d.sigma_file);
      map.sources.push_back(d.sigma_file);
      sizes.push_back(&sigma);
    }
    for (const Layer* one : sizes) {
      if (one->width != map.width || one->height != map.height) {
        throw InputError(fmt::format(
            "{}: a map of {} is {} x {} pixels and the first is {} x {}: expected equal sizes.",
            path.string(), d.symbol, one->width, one->height, map.width, map.height));
      }
    }
  }
  return map;
}

}  // namespace meltproof::validation

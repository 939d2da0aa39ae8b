// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/element_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <gsl/gsl_statistics_double.h>

#include "base/error.hpp"

namespace meltproof::validation {
namespace {

/// Bilinear value at pixel coordinates, whose integers are the pixels' centres.
double bilinear(const ElementMap& map, const std::vector<double>& values, double x, double y) {
  const auto left = std::min(static_cast<std::size_t>(x), map.width - 2);
  const auto top = std::min(static_cast<std::size_t>(y), map.height - 2);
  const double fx = x - static_cast<double>(left), fy = y - static_cast<double>(top);
  const auto at = [&](std::size_t column, std::size_t row) {
    return values[row * map.width + column];
  };
  return (1 - fy) * ((1 - fx) * at(left, top) + fx * at(left + 1, top)) +
         fy * ((1 - fx) * at(left, top + 1) + fx * at(left + 1, top + 1));
}

struct Sampled {
  std::vector<double> values;
  double mean() const { return gsl_stats_mean(values.data(), 1, values.size()); }
  double sum() const { return mean() * static_cast<double>(values.size()); }
  /// s / sqrt(n); 0 for one sample.
  double standard_error() const {
    const auto n = values.size();
    return n < 2 ? 0 : gsl_stats_sd(values.data(), 1, n) / std::sqrt(static_cast<double>(n));
  }
};

/// Pixel coordinates of the samples across the width, for one point of the line.
std::vector<std::array<double, 2>> across(const ElementMap& map, const ScanOptions::MapLine& line,
                                          double along, double length) {
  const double ux = (line.end[0] - line.start[0]) / length;
  const double uy = (line.end[1] - line.start[1]) / length;
  const double pixel = std::min(map.pixel_x, map.pixel_y);
  const auto count = static_cast<std::size_t>(std::lround(line.width / pixel)) + 1;
  std::vector<std::array<double, 2>> places;
  for (std::size_t i = 0; i < count; ++i) {
    const double part =
        count == 1 ? 0 : static_cast<double>(i) / static_cast<double>(count - 1) - 0.5;
    const double x = line.start[0] + along * ux - part * line.width * uy;
    const double y = line.start[1] + along * uy + part * line.width * ux;
    places.push_back({x / map.pixel_x, y / map.pixel_y});
    const double tolerance = 1e-6;
    const double right = static_cast<double>(map.width - 1),
                 bottom = static_cast<double>(map.height - 1);
    if (!(places.back()[0] >= -tolerance && places.back()[0] <= right + tolerance &&
          places.back()[1] >= -tolerance && places.back()[1] <= bottom + tolerance)) {
      throw InputError(fmt::format(
          "{}: the line of width {:.4g} um leaves the map at ({:.4g}, {:.4g}) um: the map reaches "
          "from (0, 0) to ({:.4g}, {:.4g}) um, x to the right and y down.",
          map.path.string(), 1e6 * line.width, 1e6 * x, 1e6 * y, 1e6 * right * map.pixel_x,
          1e6 * bottom * map.pixel_y));
    }
    places.back()[0] = std::clamp(places.back()[0], 0.0, right);
    places.back()[1] = std::clamp(places.back()[1], 0.0, bottom);
  }
  return places;
}

}  // namespace

LineScan sample_map(const ElementMap& map, const ScanOptions::MapLine& line) {
  const double length = std::hypot(line.end[0] - line.start[0], line.end[1] - line.start[1]);
  const double pixel = std::min(map.pixel_x, map.pixel_y);
  if (!(pixel > 0) || map.width < 2 || map.height < 2 || !(length >= pixel) || length > 1 ||
      !(line.width >= 0 && line.width < 1)) {
    throw InputError(fmt::format(
        "{}: a line of {:.4g} um and width {:.4g} um cannot be laid through a map of {} x {} "
        "pixels of {:.4g} um: expected at least one pixel of length, and no negative width.",
        map.path.string(), 1e6 * length, 1e6 * line.width, map.width, map.height, 1e6 * pixel));
  }
  LineScan scan;
  scan.path = map.path;
  scan.of_atoms = map.of_atoms;
  scan.voltage = map.voltage;
  scan.remarks = map.remarks;
  const auto points = static_cast<std::size_t>(std::floor(length / pixel * (1 + 1e-9))) + 1;
  for (std::size_t i = 0; i < points; ++i) {
    const double along = std::min(static_cast<double>(i) * pixel, length);
    scan.position.push_back(along);
    const auto places = across(map, line, along, length);
    for (const auto& [symbol, layer] : map.layers) {
      const auto sampled = [&, &values_at = places](const std::vector<double>& values) {
        Sampled result;
        for (const auto& place : values_at) {
          result.values.push_back(bilinear(map, values, place[0], place[1]));
        }
        return result;
      };
      ElementProfile& profile = scan.elements[symbol];
      const Sampled fractions = sampled(layer.fraction);
      if (!std::isfinite(fractions.mean())) {
        throw InputError(fmt::format(
            "{}: at {:.4g} um along the line {} was not measured: lay the line through the scanned "
            "area.",
            map.path.string(), 1e6 * along, symbol));
      }
      profile.fraction.push_back(fractions.mean());
      double u = fractions.standard_error();
      if (!layer.uncertainty.empty()) {
        double squares = 0;
        for (const double value : sampled(layer.uncertainty).values) {
          squares += value * value;
        }
        u = std::max(u, std::sqrt(squares) / static_cast<double>(places.size()));
      }
      if (places.size() > 1 || !layer.uncertainty.empty()) {
        profile.uncertainty.push_back(u);
      }
      if (!layer.counts.empty()) {
        profile.counts.push_back(sampled(layer.counts).sum());
      }
      if (!layer.background.empty()) {
        profile.background.push_back(sampled(layer.background).sum());
      }
    }
  }
  check_totals(scan);
  return scan;
}

}  // namespace meltproof::validation

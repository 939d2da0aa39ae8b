// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/linescan/strip.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.hpp"

namespace meltproof::validation {
namespace {

Point direction(const Point& start, const Point& end) {
  Point along{};
  const double length = std::hypot(end[0] - start[0], end[1] - start[1], end[2] - start[2]);
  for (std::size_t d = 0; d < 3; ++d) {
    along[d] = length > 0 ? (end[d] - start[d]) / length : 0;
  }
  return along;
}

Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Point moved(Point from, const Point& along, double by) {
  for (std::size_t d = 0; d < 3; ++d) {
    from[d] += by * along[d];
  }
  return from;
}

std::size_t cells(double extent, double spacing) {
  return extent > 0
             ? static_cast<std::size_t>(std::clamp(std::ceil(extent / (0.25 * spacing)), 3.0, 24.0))
             : 1;
}

/// The middle of cell i of n that share [0, extent].
double middle(std::size_t i, std::size_t n, double extent) {
  return (static_cast<double>(i) + 0.5) / static_cast<double>(n) * extent;
}

struct Mean {
  double value = std::numeric_limits<double>::quiet_NaN(), scatter = 0;
};

Mean mean_of(const std::vector<double>& values, const Strip& strip) {
  double weight = 0, sum = 0, plain = 0, squares = 0;
  for (const double c : values) {
    weight += strip.density(c);
    sum += strip.density(c) * c;
    plain += c / static_cast<double>(values.size());
  }
  for (const double c : values) {
    squares += (c - plain) * (c - plain);
  }
  const auto n = static_cast<double>(values.size());
  return {sum / weight, n > 1 ? std::sqrt(squares / (n - 1)) : 0};
}

}  // namespace

Point beam_direction(const std::string& axis, const Point& start, const Point& end) {
  const Point along = direction(start, end);
  if (axis.empty()) {
    std::size_t best = 0;
    for (std::size_t d = 1; d < 3; ++d) {
      best = std::abs(along[d]) < std::abs(along[best]) - 1e-9 ? d : best;
    }
    Point beam{};
    beam[best] = best == 2 ? -1 : 1;  // from above, into the plate
    // The part along the line is taken out, so that the beam stands upright on a slanted line.
    beam = moved(beam, along, -beam[best] * along[best]);
    const double length = std::hypot(beam[0], beam[1], beam[2]);
    for (double& part : beam) {
      part /= length;
    }
    return beam;
  }
  const bool turned = axis.starts_with('-');
  const std::string letter = axis.substr(turned ? 1 : 0);
  if (letter != "x" && letter != "y" && letter != "z") {
    throw InputError(
        fmt::format("--beam: \"{}\" is no axis: expected x, y, z, -x, -y or -z.", axis));
  }
  Point beam{};
  beam[static_cast<std::size_t>(letter[0] - 'x')] = turned ? -1 : 1;
  const double share = std::abs(along[static_cast<std::size_t>(letter[0] - 'x')]);
  if (share > 0.002) {
    throw InputError(fmt::format(
        "--beam: the line runs {:.3g} degrees out of the section that a beam along {} stands "
        "upright on: expected a beam across the line.",
        180 / 3.14159265358979 * std::asin(std::min(1.0, share)), axis));
  }
  return beam;
}

StripProfile sample_strip(const SolidifiedTrack& track, const Strip& strip) {
  // The line's own samples, and its errors.
  const SimulatedProfile line = sample_line(track, strip.start, strip.end, strip.step);
  const double step = line.position[1] - line.position[0];
  const auto margin = static_cast<std::ptrdiff_t>(std::ceil(strip.margin / step));
  const Point along = direction(strip.start, strip.end), across = cross(strip.beam, along);
  const double deepest = std::max(strip.depth(0), strip.depth(1));
  Point low = strip.start, high = strip.start;
  for (const double s : {-strip.margin - step, line.position.back() + strip.margin + step}) {
    for (const double w : {-0.5 * strip.width, 0.5 * strip.width}) {
      for (const double z : {0.0, deepest}) {
        const Point corner = moved(moved(moved(strip.start, along, s), across, w), strip.beam, z);
        for (std::size_t d = 0; d < 3; ++d) {
          low[d] = std::min(low[d], corner[d]);
          high[d] = std::max(high[d], corner[d]);
        }
      }
    }
  }
  const TrackField field(track, low, high);
  StripProfile profile;
  const std::size_t wide = cells(strip.width, track.spacing);
  const std::size_t deep = cells(deepest, track.spacing);
  profile.samples = wide * deep;
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  for (std::ptrdiff_t i = -margin; i < std::ssize(line.position) + margin; ++i) {
    const double s = static_cast<double>(i) * step;
    const Point at = moved(strip.start, along, s);
    const double on_line = field.at(at);
    profile.position.push_back(s);
    profile.on_line.push_back(on_line);
    Mean mean;
    const double depth = strip.depth(std::isnan(on_line) ? 0 : on_line);
    if (!std::isnan(on_line)) {
      std::vector<double> values;
      for (std::size_t w = 0; w < wide; ++w) {
        for (std::size_t z = 0; z < deep; ++z) {
          const double value =
              field.at(moved(moved(at, across, middle(w, wide, strip.width) - 0.5 * strip.width),
                             strip.beam, depth > 0 ? middle(z, deep, depth) : 0));
          if (!std::isnan(value)) {
            values.push_back(value);
          }
        }
      }
      mean = values.empty() ? Mean{on_line, 0} : mean_of(values, strip);
    }
    profile.mean.push_back(mean.value);
    profile.scatter.push_back(std::isnan(on_line) ? nothing : mean.scatter);
    profile.density.push_back(strip.density(std::isnan(mean.value) ? 0 : mean.value));
    profile.depth.push_back(depth);
  }
  return profile;
}

}  // namespace meltproof::validation

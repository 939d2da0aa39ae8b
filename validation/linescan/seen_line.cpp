// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/linescan/seen_line.hpp"

#include <algorithm>
#include <cmath>

#include "validation/eds/elements.hpp"
#include "validation/eds/interaction_volume.hpp"
#include "validation/linescan/budget.hpp"

namespace meltproof::validation {
namespace {

/// Without the margin: the points from 0 to the line's end.
template <class T>
void cut(std::vector<T>& list, std::size_t margin) {
  list.erase(list.end() - static_cast<std::ptrdiff_t>(margin), list.end());
  list.erase(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(margin));
}

}  // namespace

SeenLine see_line(const SolidifiedTrack& track, const LineRequest& request, const Point& start,
                  const Point& end) {
  SeenLine line;
  line.element = request.from == Estimate::silicon ? "Si" : "Al";
  line.edge = *element(line.element).k_edge;
  line.range = anderson_hasler_range(iron.density, request.voltage, line.edge);
  line.sigma_in_iron = request.sigma.value_or(interaction_sigma(line.range));
  // A width that is given by hand is one width, whatever the matrix.
  const Matrix matrix = request.sigma ? Matrix::iron : request.matrix;
  const auto density = [matrix](double concentration) {
    return matrix == Matrix::iron        ? iron.density
           : matrix == Matrix::aluminium ? aluminium.density
                                         : mixture_density(concentration);
  };
  const double mass_range = line.range * iron.density;  // the range is inverse to the density
  const double mass_sigma = line.sigma_in_iron * iron.density;
  Strip strip;
  strip.start = start;
  strip.end = end;
  strip.step = request.step;
  strip.width = request.width;
  strip.beam = beam_direction(request.beam, start, end);
  strip.density = density;
  strip.depth = [&](double concentration) {
    return request.depth.value_or(mass_range / density(concentration));
  };
  strip.margin = 4 * mass_sigma / std::min(density(0), density(1));
  line.beam = strip.beam;
  line.strip = sample_strip(track, strip);
  const double step = line.strip.position[1] - line.strip.position[0];
  line.seen = convolve_in_matrix(line.strip.mean, line.strip.density, step, mass_sigma);
  const auto margin = static_cast<std::size_t>(std::ceil(strip.margin / step));
  line.u_spacing = edge_uncertainty(line.strip.position, line.seen, track.spacing);
  for (auto* list :
       {&line.strip.position, &line.strip.on_line, &line.strip.mean, &line.strip.scatter,
        &line.strip.density, &line.strip.depth, &line.seen, &line.u_spacing}) {
    cut(*list, margin);
  }
  if (request.numerical) {
    std::fill(line.u_spacing.begin(), line.u_spacing.end(), *request.numerical);
  }
  for (std::size_t i = 0; i < line.seen.size(); ++i) {
    line.sigma.push_back(mass_sigma / line.strip.density[i]);
    line.u_strip.push_back(strip_uncertainty(line.strip.scatter[i], request.width,
                                             line.strip.depth[i], track.spacing));
    line.largest_range = std::max(line.largest_range, mass_range / line.strip.density[i]);
  }
  return line;
}

}  // namespace meltproof::validation

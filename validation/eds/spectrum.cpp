// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/spectrum.hpp"

#include <algorithm>

#include "validation/eds/elements.hpp"

namespace meltproof::validation {
namespace {

/// Side windows in keV, where steels and aluminium alloys have no line of their own.
struct Sides {
  const char* element;
  double low_from, low_to, high_from, high_to;
};
constexpr Sides sides[] = {
    {"Mg", 1.02, 1.12, 1.94, 2.00},  // Mg, Al and Si stand too close for a gap between them
    {"Al", 1.02, 1.12, 1.94, 2.00}, {"Si", 1.02, 1.12, 1.94, 2.00}, {"S", 2.10, 2.18, 2.58, 2.68},
    {"Cr", 5.15, 5.25, 5.62, 5.72}, {"Fe", 6.15, 6.25, 6.66, 6.76}, {"Ni", 7.23, 7.32, 7.66, 7.76},
    {"Cu", 7.74, 7.84, 8.34, 8.44},
};
constexpr double half_window = 0.1;  // keV

/// Mean counts per channel; nothing if no channel lies there.
std::optional<double> level(const Spectrum& spectrum, double low, double high) {
  double sum = 0;
  std::size_t channels = 0;
  for (std::size_t i = 0; i < spectrum.counts.size(); ++i) {
    if (spectrum.energy(i) >= low && spectrum.energy(i) <= high) {
      sum += spectrum.counts[i];
      ++channels;
    }
  }
  return channels > 0 ? std::optional(sum / static_cast<double>(channels)) : std::nullopt;
}

}  // namespace

double counts_between(const Spectrum& spectrum, double low, double high) {
  double sum = 0;
  for (std::size_t i = 0; i < spectrum.counts.size(); ++i) {
    if (spectrum.energy(i) >= low && spectrum.energy(i) <= high) {
      sum += spectrum.counts[i];
    }
  }
  return sum;
}

std::vector<WindowCounts> window_counts(const Spectrum& spectrum) {
  std::vector<WindowCounts> result;
  if (spectrum.along_a_line || spectrum.counts.empty()) {
    return result;
  }
  const double end = spectrum.energy(spectrum.counts.size() - 1);
  for (const auto& side : sides) {
    const auto below = level(spectrum, side.low_from, side.low_to);
    const auto above = level(spectrum, side.high_from, side.high_to);
    if (!below || !above || side.high_to > end || side.low_from < spectrum.first_energy) {
      continue;
    }
    WindowCounts window;
    window.element = side.element;
    window.energy = *element(side.element).k_alpha;
    window.gross =
        counts_between(spectrum, window.energy - half_window, window.energy + half_window);
    const double left = 0.5 * (side.low_from + side.low_to);
    const double right = 0.5 * (side.high_from + side.high_to);
    for (std::size_t i = 0; i < spectrum.counts.size(); ++i) {
      const double at = spectrum.energy(i);
      if (at >= window.energy - half_window && at <= window.energy + half_window) {
        window.background += *below + (*above - *below) * (at - left) / (right - left);
      }
    }
    window.net = window.gross - window.background;
    window.noise = counting_noise(window.net, window.background);
    result.push_back(window);
  }
  return result;
}

}  // namespace meltproof::validation

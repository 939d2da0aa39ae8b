// SPDX-License-Identifier: GPL-3.0-or-later
// An X-ray spectrum, the counts in its windows, and a composition that a program made of it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "validation/eds/composition.hpp"
#include "validation/eds/line_scan.hpp"

namespace meltproof::validation {

struct Spectrum {
  std::filesystem::path path;
  std::string title;
  double first_energy = 0;         ///< of channel 0, keV
  double channel_width = 0;        ///< keV
  std::vector<double> counts;      ///< one per channel
  std::optional<double> voltage;   ///< of the beam, kV
  std::optional<double> livetime;  ///< s
  /// Not energies but places along a line in m, as some programs export a line of one element.
  bool along_a_line = false;
  double energy(std::size_t channel) const {
    return first_energy + channel_width * static_cast<double>(channel);
  }
};

/// Counts in a window around a K line.
struct WindowCounts {
  std::string element;
  double energy = 0;  ///< of the line, keV
  double gross = 0;   ///< all counts within 100 eV of the line
  double background =
      0;             ///< B: under the straight line between the mean counts of two side windows
  double net = 0;    ///< N = gross - B
  double noise = 0;  ///< sqrt(N + 2B), one standard deviation
};

/// Sum over the channels whose energy lies in [low, high], keV.
double counts_between(const Spectrum& spectrum, double low, double high);

/// The windows of Mg, Al, Si, S, Cr, Fe, Ni and Cu K-alpha that lie in the spectrum with their side
/// windows. Counts, not a composition: neither absorption nor overlaps are corrected.
std::vector<WindowCounts> window_counts(const Spectrum& spectrum);

/// What a vendor's program made of a spectrum: one point of a line scan. As reported, not
/// normalised.
struct PointComposition {
  ElementFractions mass;
  ElementFractions atom;                             ///< empty if not reported
  std::map<std::string, double> counts, background;  ///< of each element's line; empty if not there
  std::optional<double> voltage;                     ///< kV
};

}  // namespace meltproof::validation

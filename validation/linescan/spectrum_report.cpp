// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/linescan/spectrum_report.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "validation/eds/formats.hpp"

namespace meltproof::validation {
namespace {

// A straight line under a curved background leaves this share of it over, also without any peak: up
// to 11 % under Mg to Si in a spectrum of pure iron.
constexpr double curvature = 0.15;

std::string of_spectrum(const Spectrum& s) {
  const double sum = std::accumulate(s.counts.begin(), s.counts.end(), 0.0);
  if (s.along_a_line) {
    return fmt::format(
        "  intensities along a line: {} points, sum {:.0f}; they are no composition\n",
        s.counts.size(), sum);
  }
  std::string text =
      fmt::format("  spectrum: {} channels of {:.5g} eV from {:.6g} eV, {:.0f} counts{}{}\n",
                  s.counts.size(), 1e3 * s.channel_width, 1e3 * s.first_energy, sum,
                  s.voltage ? fmt::format(", beam {} kV", *s.voltage) : "",
                  s.livetime ? fmt::format(", live time {} s", *s.livetime) : "");
  const auto windows = window_counts(s);
  if (!windows.empty()) {
    text += "  window   energy     gross  background        net  noise\n";
  }
  for (const auto& w : windows) {
    text += fmt::format("  {:>2}-K  {:7.4f} keV {:9.0f} {:11.1f} {:10.1f} {:6.1f}{}\n", w.element,
                        w.energy, w.gross, w.background, w.net, w.noise,
                        w.net < std::max(3 * w.noise, curvature * w.background)
                            ? "  not told from the background"
                            : "");
  }
  if (!windows.empty()) {
    text +=
        "  Net counts within 100 eV of the line, background straight between two side windows, "
        "noise\n  sqrt(N + 2B). They are counts, not a composition: absorption, overlaps and tails "
        "of large\n  peaks are not corrected.\n";
  }
  return text;
}

std::string of_point(const LineScan& scan, const MeasuredRequest& request) {
  ElementFractions mass;
  std::string text = "  composition, as reported:";
  for (const auto& [symbol, profile] : scan.elements) {
    mass[symbol] = profile.fraction[0];
  }
  const auto atom = atom_from_mass(mass);
  for (const auto& [symbol, value] : mass) {
    text += fmt::format("  {} {:.2f} wt% ({:.2f} at%)", symbol, 100 * value, 100 * atom.at(symbol));
  }
  text += fmt::format("\n  total {:.2f} %{}; at% are of this total\n", 100 * scan.total[0],
                      scan.flagged.empty() ? "" : ", outside 95 to 105 %");
  nlohmann::json agreement;
  std::vector<Warning> warnings;
  const auto estimates = estimates_json(scan, request, agreement, warnings);
  for (const char* name : {"Al", "Si", "least_squares"}) {
    if (estimates.at(name).is_object()) {
      text += fmt::format("  AlSi10Mg from {}: {:.2f} wt%\n", name,
                          100 * estimates.at(name).at("concentration").at(0).get<double>());
    }
  }
  for (const auto& warning : warnings) {
    text += "  " + warning.sentence + "\n";
  }
  return text;
}

std::string of_line(const LineScan& scan) {
  std::string text = fmt::format(
      "  line of {} points over {:.4g} um in {}, elements:", scan.position.size(),
      1e6 * (scan.position.back() - scan.position.front()), scan.of_atoms ? "at%" : "wt%");
  for (const auto& [symbol, profile] : scan.elements) {
    text += fmt::format(" {}{}{}", symbol, profile.uncertainty.empty() ? "" : " (sigma)",
                        profile.counts.empty() ? "" : " (counts)");
  }
  text += scan.alloy ? " AlSi10Mg itself\n" : "\n";
  for (const auto& remark : scan.remarks) {
    text += "  " + remark + "\n";
  }
  return text;
}

}  // namespace

std::string describe_export(const MeasuredRequest& request) {
  const EdsExport found = read_eds_export(request.path);
  std::string text = fmt::format("{}: {}\n", request.path.string(), found.format);
  if (found.spectrum) {
    text += of_spectrum(*found.spectrum);
  }
  if (found.line && found.line->empty_slot) {
    text += "  an empty slot: no point yet\n";
  } else if (found.line) {
    text += found.line->position.size() == 1 && !found.line->alloy && !found.line->of_atoms
                ? of_point(*found.line, request)
                : of_line(*found.line);
  }
  if (found.map) {
    text += fmt::format("  map of {} x {} pixels of {:.4g} um in {}, elements:", found.map->width,
                        found.map->height, 1e6 * found.map->pixel_x,
                        found.map->of_atoms ? "at%" : "wt%");
    for (const auto& [symbol, layer] : found.map->layers) {
      text += " " + symbol;
    }
    text += "\n";
  }
  return text;
}

}  // namespace meltproof::validation

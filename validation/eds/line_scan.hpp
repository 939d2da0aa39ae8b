// SPDX-License-Identifier: GPL-3.0-or-later
// An EDS line scan, whatever file it comes from.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace meltproof::validation {

/// One element along the line. Every list is empty or has one entry per point.
struct ElementProfile {
  std::vector<double> fraction;     ///< as reported, 1 for 100 %
  std::vector<double> uncertainty;  ///< standard uncertainty in the same way; empty if not reported
  std::vector<double> counts;       ///< net counts N of the peak
  std::vector<double> background;   ///< counts B of the background under it
};

struct LineScan {
  std::filesystem::path path;
  std::string format;            ///< of the reader, for example "CSV export"
  std::vector<double> position;  ///< m, strictly increasing
  bool of_atoms = false;         ///< at%; otherwise wt%
  std::map<std::string, ElementProfile> elements;
  /// Mass fraction of AlSi10Mg where the file states that itself, as the slots of
  /// data/experiments do; `elements` is empty then.
  std::optional<ElementProfile> alloy;
  std::vector<double> total;         ///< reported, or the sum over the elements; 1 for 100 %
  std::vector<std::size_t> flagged;  ///< points whose total lies outside 95 to 105 %
  std::optional<double> voltage;     ///< kV, where the file states it
  bool empty_slot = false;           ///< a slot of data/experiments that holds no point yet
  std::vector<std::filesystem::path> sources;  ///< other files that it was read from
  std::vector<std::string> remarks;            ///< sentences on what was passed over or is odd
};

/// Fills `total` (if empty) and `flagged`, and remarks on totals: outside 95 to 105 %, and 100 % at
/// every point, as a program writes them that normalised.
void check_totals(LineScan& scan);

/// Standard deviation sqrt(N + 2B) of a net count N over a background of B counts.
double counting_noise(double net, double background);

/// What a reader may have to be told, in m.
struct ScanOptions {
  std::optional<double> point_spacing;  ///< between the spectra of a folder
  struct MapLine {
    double start[2] = {0, 0}, end[2] = {0, 0};  ///< x to the right, y down, from the first pixel
    double width = 0;                           ///< averaged across; 0: on the line only
  };
  std::optional<MapLine> map_line;  ///< where a map is sampled
};

/// Reads a line scan from any format of eds_formats(), or from a folder of spectra with the
/// vendor's quantification, in the order of the numbers in their names.
/// @throws InputError with a sentence for: a format that is not known, a damaged file, no position
/// or no unit of it, no element, neither wt% nor at%, positions that do not increase, a map without
/// a line or the other way round, a file that holds spectra but no composition.
LineScan read_line_scan(const std::filesystem::path& path, const ScanOptions& options = {});

}  // namespace meltproof::validation

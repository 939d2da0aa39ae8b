// SPDX-License-Identifier: GPL-3.0-or-later
// A quantified EDS line scan as the microscope's programs export it (CSV), and the concentration of
// AlSi10Mg along it.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace meltproof::validation {

/// One element along the line.
struct ElementProfile {
  std::vector<double> fraction;     ///< as reported, 1 for 100 %; one per point
  std::vector<double> uncertainty;  ///< standard uncertainty in the same way; empty if not reported
};

struct LineScan {
  std::filesystem::path path;
  std::vector<double> position;  ///< m, strictly increasing
  bool of_atoms = false;         ///< at%; otherwise wt%
  std::map<std::string, ElementProfile> elements;
  std::vector<double> total;         ///< reported, or the sum over the elements; 1 for 100 %
  std::vector<std::size_t> flagged;  ///< points whose total lies outside 95 to 105 %
};

/// Reads a CSV export. Found by itself: separator (comma, semicolon, tab), decimal comma, lines
/// before the table, one or two header lines, position in nm, um or mm, wt% or at% (wt% if both are
/// there), columns with the uncertainty ("sigma", "error") and the total. Columns of counts are
/// passed over.
/// @throws InputError with a sentence for: no table, no position or no unit of it, no element,
/// neither
///         wt% nor at%, a cell without number, positions that do not increase.
LineScan read_line_scan(const std::filesystem::path& path);

/// Concentration of AlSi10Mg along a scan. Nothing is normalised, except at% on their way to wt%.
struct ConcentrationProfile {
  std::vector<double> position;       ///< m
  std::vector<double> concentration;  ///< mass fraction of AlSi10Mg
  std::vector<double> uncertainty;    ///< standard uncertainty; empty if not reported
};
/// From aluminium. @throws InputError if the scan has none.
ConcentrationProfile concentration_from_aluminium(const LineScan& scan);
/// From silicon, with the mass fraction of silicon in the steel. @throws InputError if it has none.
ConcentrationProfile concentration_from_silicon(const LineScan& scan, double silicon_of_base);

}  // namespace meltproof::validation

// SPDX-License-Identifier: GPL-3.0-or-later
// One line scan: simulated, seen as the electron beam sees it, and compared with a measured one.
#pragma once

#include <filesystem>
#include <optional>

#include <nlohmann/json.hpp>

#include "validation/linescan/grain.hpp"
#include "validation/linescan/measured_line.hpp"
#include "validation/linescan/registration.hpp"

namespace meltproof::validation {

/// The matrix that the electrons run through.
enum class Matrix {
  local,  ///< what stands there: the width varies along the line
  iron,
  aluminium,
};

/// What is asked of a line scan. Lengths in m.
struct LineRequest {
  std::filesystem::path run;
  std::optional<Direction>
      grain;  ///< through the grain at the pool's edge; otherwise start and end
  Point start{}, end{};
  double length = 20e-6;        ///< of the line through a grain
  double step = 0.25e-6;        ///< between samples
  double voltage = 30;          ///< kV, of the electron beam
  double width = 1e-6;          ///< of the scan, across the line
  std::optional<double> depth;  ///< of the strip; absent: the range of the X-rays
  std::string beam;             ///< axis into the section; empty: see beam_direction()
  Matrix matrix = Matrix::local;
  std::optional<double> sigma;     ///< of the interaction volume; 0: none; absent: from the range
  std::filesystem::path measured;  ///< any file of read_line_scan(); empty: none yet
  ScanOptions options;             ///< what its reader must be told
  Estimate from = Estimate::aluminium;
  ElementFractions base = steel_316l_composition();  ///< mass fractions of the steel
  bool base_given = false;
  RegistrationBounds bounds;
  std::optional<double> numerical;   ///< u of the simulated concentration; absent: from the spacing
  std::optional<double> systematic;  ///< relative u of the quantification that all points share
  double coverage = 2;               ///< k of E +- k u_val
};

/// Samples, convolves and compares. Result (see validation/README.md): status "compared" or
/// "pending" (no measurement, or an empty slot), line, grain, interaction, simulated, measured,
/// compared, metrics, metrics_before, registration, uncertainty, vv20, warnings.
/// @throws InputError for anything that cannot be used.
/// @throws NoGrain if a grain is asked for and none melted.
nlohmann::json compare_line(const LineRequest& request);

/// The run holds no molten grain of the additive.
class NoGrain : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace meltproof::validation

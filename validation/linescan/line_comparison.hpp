// SPDX-License-Identifier: GPL-3.0-or-later
// One line scan: simulated, seen as the electron beam sees it, and compared with a measured one.
#pragma once

#include <filesystem>
#include <optional>

#include <nlohmann/json.hpp>

#include "validation/linescan/grain.hpp"
#include "validation/linescan/registration.hpp"

namespace meltproof::validation {

/// What is asked of a line scan. Lengths in m.
struct LineRequest {
  std::filesystem::path run;
  std::optional<Direction>
      grain;  ///< through the grain at the pool's edge; otherwise start and end
  Point start{}, end{};
  double length = 20e-6;           ///< of the line through a grain
  double step = 0.25e-6;           ///< between samples
  double voltage = 30;             ///< kV, of the electron beam
  std::optional<double> sigma;     ///< of the interaction volume; 0: none; absent: from the range
  std::filesystem::path measured;  ///< CSV of a line scan; empty: none yet
  bool from_silicon = false;       ///< concentration from Si instead of Al
  double silicon_of_base = 0;      ///< mass fraction of Si in the steel
  RegistrationBounds bounds;
};

/// Samples, convolves and compares. Result (see validation/README.md): status "compared" or
/// "pending" (no measurement), line, grain, interaction, simulated, measured, metrics,
/// metrics_before, registration.
/// @throws InputError for anything that cannot be used.
/// @throws NoGrain if a grain is asked for and none melted.
nlohmann::json compare_line(const LineRequest& request);

/// The run holds no molten grain of the additive.
class NoGrain : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace meltproof::validation

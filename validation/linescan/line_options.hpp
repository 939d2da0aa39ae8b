// SPDX-License-Identifier: GPL-3.0-or-later
// What a user types to meltproof-linescan, and what is understood of it.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "validation/linescan/line_comparison.hpp"

namespace meltproof::validation {

/// Options as typed, before they are understood.
struct TypedLine {
  std::string run, output = "linescan.json", spectrum;
  std::string grain, start, end, length = "20 um", step = "0.25 um";
  std::string width = "1 um", depth, beam, voltage = "30 kV", matrix = "local", sigma;
  std::string measured, element = "Al", base, silicon, map_start, map_end, map_width = "0 um";
  std::string point_spacing, shift = "0 um", landmark, numerical, systematic;
  bool reversible = false;
};

/// What the program does, how to bring one's own file, and an example for each format.
std::string line_scan_help();

void add_line_options(CLI::App& app, TypedLine& typed);

/// @throws InputError naming the option for what cannot be understood.
LineRequest understand(const TypedLine& typed);
MeasuredRequest understand_spectrum(const TypedLine& typed);

}  // namespace meltproof::validation

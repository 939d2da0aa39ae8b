// SPDX-License-Identifier: GPL-3.0-or-later
// What a run writes down as it goes: one line per interval, and what follows from the lines.
#pragma once

#include <string>
#include <vector>

#include "solver/output/melt_pool.hpp"
#include "solver/step/engine.hpp"

namespace meltproof::solver {

/// One line of history.csv; SI inside.
struct HistoryLine {
  double time = 0, step = 0;      ///< s
  double beam_x = 0;              ///< m
  Extent pool;                    ///< connected region at or above the reference temperature
  Extent any_liquid;              ///< everything at or above its own liquidus, connected or not
  double peak_temperature = 0;    ///< K
  double absorbed_power = 0;      ///< W, at this moment
  double absorbed = 0, lost = 0;  ///< J, since the start
  double enthalpy_change = 0;     ///< J, since the start
};

/// Measures the engine's present state. @param reference_temperature K, the base material's
/// liquidus;
/// @param start_enthalpy J, the total at time zero.
HistoryLine measure(const Engine& engine, double reference_temperature, double start_enthalpy);

/// history.csv: a header with units, a line per entry, lengths in um, times in us.
std::string history_csv(const std::vector<HistoryLine>& lines);

/// Mean, scatter and growth of a quantity over the lines with time in [from, to].
struct WindowMean {
  double mean = 0, deviation = 0;  ///< in the quantity's unit; sample standard deviation
  double growth = 0;               ///< per second, slope of the least-squares line
  std::size_t count = 0;
};
WindowMean window_mean(const std::vector<HistoryLine>& lines, double from, double to,
                       double (*quantity)(const HistoryLine&));

}  // namespace meltproof::solver

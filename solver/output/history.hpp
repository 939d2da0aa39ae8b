// SPDX-License-Identifier: GPL-3.0-or-later
// What a run writes down as it goes: one line per interval, and what follows from the lines.
#pragma once

#include <string>
#include <vector>

#include "solver/output/melt_pool.hpp"
#include "solver/output/steady_state.hpp"
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
  double largest_speed = 0;       ///< m s-1, of the melt
  double mean_speed = 0;          ///< m s-1, mean of |v| over the melt's particles
  double liquid_volume = 0;       ///< m3, mass over reference density of the melt
  std::size_t lost_particles = 0;
  double clumped = 0;          ///< share of the melt nearer than half a spacing to a neighbour
  double evaporated_mass = 0;  ///< kg, since the start
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

/// Whether the quantity is steady at the end of the exposure, or what it tends to, from the lines
/// with time in [start_up, until]; see steady_state.hpp.
SteadyState steadiness(const std::vector<HistoryLine>& lines, double start_up, double until,
                       double (*quantity)(const HistoryLine&));

/// The same for pool length, width and depth and the length of any liquid, in um: an object per
/// quantity, named as the columns of history.csv.
nlohmann::json steadiness_json(const std::vector<HistoryLine>& lines, double start_up,
                               double until);

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/history.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace meltproof::solver {

HistoryLine measure(const Engine& engine, double reference_temperature, double start_enthalpy) {
  const Particles& p = engine.particles();
  HistoryLine line;
  line.time = engine.time();
  line.beam_x = engine.model().laser ? engine.model().laser->x(engine.time()) : 0;
  std::vector<double> level(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    level[i] = p.temperature[i] - reference_temperature;
    line.peak_temperature = std::max(line.peak_temperature, p.temperature[i]);
  }
  line.pool = measure_extent(p, engine.neighbours(), level, true);
  for (std::size_t i = 0; i < p.size(); ++i) {
    level[i] = p.temperature[i] - engine.mixture().liquidus(p.concentration[i]);
  }
  line.any_liquid = measure_extent(p, engine.neighbours(), level, false);
  line.absorbed_power = engine.beam().absorbed;
  line.absorbed = engine.ledger().absorbed;
  line.lost = engine.ledger().evaporated + engine.ledger().radiated;
  line.enthalpy_change = engine.total_enthalpy() - start_enthalpy;
  return line;
}

std::string history_csv(const std::vector<HistoryLine>& lines) {
  std::string out =
      "time [us],dt [us],beam_x [um],pool_length [um],pool_width [um],pool_depth [um],pool_onset_x "
      "[um],pool_end_x [um],"
      "pool_volume [um3],any_liquid_length [um],any_liquid_width [um],any_liquid_depth "
      "[um],peak_temperature [K],"
      "absorbed_power [W],absorbed [J],lost [J],enthalpy_change [J]\n";
  for (const auto& line : lines) {
    const Extent& pool = line.pool;
    const Extent& liquid = line.any_liquid;
    out += fmt::format(
        "{:.6f},{:.6f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.2f},{:.4f},{:.4f},{:.4f},{:.3f}"
        ",{:.6f},{:.9e},{:.9e},{:.9e}\n",
        1e6 * line.time, 1e6 * line.step, 1e6 * line.beam_x, 1e6 * pool.length, 1e6 * pool.width,
        1e6 * pool.depth, 1e6 * pool.onset, 1e6 * pool.end, 1e18 * pool.volume, 1e6 * liquid.length,
        1e6 * liquid.width, 1e6 * liquid.depth, line.peak_temperature, line.absorbed_power,
        line.absorbed, line.lost, line.enthalpy_change);
  }
  return out;
}

WindowMean window_mean(const std::vector<HistoryLine>& lines, double from, double to,
                       double (*quantity)(const HistoryLine&)) {
  WindowMean result;
  double sum = 0, time_sum = 0;
  // Half an interval of tolerance is not needed: lines stand exactly at their times.
  const auto inside = [&](const HistoryLine& line) {
    return line.time >= from * (1 - 1e-12) && line.time <= to * (1 + 1e-12);
  };
  for (const auto& line : lines) {
    if (inside(line)) {
      sum += quantity(line);
      time_sum += line.time;
      ++result.count;
    }
  }
  if (result.count == 0) {
    return result;
  }
  const auto n = static_cast<double>(result.count);
  result.mean = sum / n;
  double squares = 0, product = 0, time_squares = 0;
  for (const auto& line : lines) {
    if (inside(line)) {
      const double d = quantity(line) - result.mean, t = line.time - time_sum / n;
      squares += d * d;
      product += d * t;
      time_squares += t * t;
    }
  }
  result.deviation = result.count > 1 ? std::sqrt(squares / (n - 1)) : 0;
  result.growth = time_squares > 0 ? product / time_squares : 0;
  return result;
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/history.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "solver/output/acceptance.hpp"
#include "solver/particles/block_sum.hpp"

namespace meltproof::solver {

namespace {

constexpr double nowhere = -std::numeric_limits<double>::infinity();

/// Speed, volume, clumping and losses of the melt.
void measure_melt(HistoryLine& line, const Particles& p, bool flow) {
  const auto molten = [&](std::size_t i) {
    return flow ? p.phase[i] == Phase::liquid : p.liquid_fraction[i] >= 1;
  };
  const auto speed = [&](std::size_t i) {
    return std::hypot(p.velocity[i][0], p.velocity[i][1], p.velocity[i][2]);
  };
  const double count = block_sum(p.size(), [&](std::size_t i) { return molten(i) ? 1.0 : 0.0; });
  const double sum = block_sum(p.size(), [&](std::size_t i) { return molten(i) ? speed(i) : 0.0; });
  line.mean_speed = count > 0 ? sum / count : 0;
  line.largest_speed =
      block_max(p.size(), 0, [&](std::size_t i) { return molten(i) ? speed(i) : 0.0; });
  line.liquid_volume =
      block_sum(p.size(), [&](std::size_t i) { return molten(i) ? p.volume[i] : 0.0; });
  line.lost_particles =
      static_cast<std::size_t>(std::count(p.phase.begin(), p.phase.end(), Phase::lost));
  line.clumped = flow ? clumped_fraction(p) : 0;
}

}  // namespace

HistoryLine measure(const Engine& engine, double reference_temperature, double start_enthalpy) {
  const Particles& p = engine.particles();
  HistoryLine line;
  line.time = engine.time();
  line.beam_x = engine.model().laser ? engine.model().laser->x(engine.time()) : 0;
  std::vector<double> level(p.size());
  // What has left the domain keeps its temperature for ever and is not part of any pool.
  const auto here = [&](std::size_t i) { return p.phase[i] != Phase::lost; };
  for (std::size_t i = 0; i < p.size(); ++i) {
    level[i] = here(i) ? p.temperature[i] - reference_temperature : nowhere;
    line.peak_temperature = std::max(line.peak_temperature, here(i) ? p.temperature[i] : 0.0);
  }
  line.pool = measure_extent(p, engine.neighbours(), level, true);
  for (std::size_t i = 0; i < p.size(); ++i) {
    level[i] = here(i) ? p.temperature[i] - engine.mixture().liquidus(p.concentration[i]) : nowhere;
  }
  line.any_liquid = measure_extent(p, engine.neighbours(), level, false);
  line.absorbed_power = engine.beam().absorbed;
  line.absorbed = engine.ledger().absorbed;
  line.lost = engine.ledger().evaporated + engine.ledger().radiated + engine.ledger().convected;
  line.evaporated_mass = engine.ledger().evaporated_mass;
  line.enthalpy_change = engine.total_enthalpy() - start_enthalpy;
  measure_melt(line, p, engine.model().flow.has_value());
  return line;
}

std::string history_csv(const std::vector<HistoryLine>& lines) {
  std::string out =
      "time [us],dt [us],beam_x [um],pool_length [um],pool_width [um],pool_depth [um],pool_onset_x "
      "[um],pool_end_x [um],"
      "pool_volume [um3],any_liquid_length [um],any_liquid_width [um],any_liquid_depth "
      "[um],peak_temperature [K],"
      "absorbed_power [W],absorbed [J],lost [J],enthalpy_change [J],largest_speed "
      "[m/s],mean_speed [m/s],liquid_volume [um3],lost_particles [1],clumped_fraction "
      "[1],evaporated_mass [ug]\n";
  for (const auto& line : lines) {
    const Extent& pool = line.pool;
    const Extent& liquid = line.any_liquid;
    out += fmt::format(
        "{:.6f},{:.6f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.2f},{:.4f},{:.4f},{:.4f},{:.3f}"
        ",{:.6f},{:.9e},{:.9e},{:.9e},{:.5f},{:.5f},{:.2f},{},{:.6f},{:.9e}\n",
        1e6 * line.time, 1e6 * line.step, 1e6 * line.beam_x, 1e6 * pool.length, 1e6 * pool.width,
        1e6 * pool.depth, 1e6 * pool.onset, 1e6 * pool.end, 1e18 * pool.volume, 1e6 * liquid.length,
        1e6 * liquid.width, 1e6 * liquid.depth, line.peak_temperature, line.absorbed_power,
        line.absorbed, line.lost, line.enthalpy_change, line.largest_speed, line.mean_speed,
        1e18 * line.liquid_volume, line.lost_particles, line.clumped, 1e9 * line.evaporated_mass);
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

SteadyState steadiness(const std::vector<HistoryLine>& lines, double start_up, double until,
                       double (*quantity)(const HistoryLine&)) {
  std::vector<double> time, value;
  for (const auto& line : lines) {
    if (line.time <= until * (1 + 1e-12)) {
      time.push_back(line.time);
      value.push_back(quantity(line));
    }
  }
  SteadySettings settings;
  settings.start_up = start_up;
  return judge_steadiness(time, value, settings);
}

nlohmann::json steadiness_json(const std::vector<HistoryLine>& lines, double start_up,
                               double until) {
  nlohmann::json result;
  const auto add = [&](const std::string& key, const std::string& name,
                       double (*quantity)(const HistoryLine&)) {
    result[key] = steadiness(lines, start_up, until, quantity).json(name, 1e6, "um");
  };
  add("pool_length", "length of the pool", [](const HistoryLine& l) { return l.pool.length; });
  add("pool_width", "width of the pool", [](const HistoryLine& l) { return l.pool.width; });
  add("pool_depth", "depth of the pool", [](const HistoryLine& l) { return l.pool.depth; });
  add("any_liquid_length", "length of any liquid",
      [](const HistoryLine& l) { return l.any_liquid.length; });
  return result;
}

}  // namespace meltproof::solver

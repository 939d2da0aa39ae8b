// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/history.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "solver/output/acceptance.hpp"
#include "solver/particles/exact_sum.hpp"

namespace meltproof::solver {

namespace {

constexpr double nowhere = -std::numeric_limits<double>::infinity();

/// Sums and extremes over the melt of all ranks, and over everything.
void measure_melt(HistoryLine& line, const Engine& engine) {
  const Particles& p = engine.particles();
  const Ranks& ranks = engine.ranks();
  const bool flow = engine.model().flow.has_value();
  const auto here = [&](std::size_t i) { return p.home[i] == Home::here; };
  const auto molten = [&](std::size_t i) {
    return here(i) && (flow ? p.phase[i] == Phase::liquid : p.liquid_fraction[i] >= 1);
  };
  const auto speed = [&](std::size_t i) {
    return std::hypot(p.velocity[i][0], p.velocity[i][1], p.velocity[i][2]);
  };
  std::array<std::uint64_t, 2> count{};  // molten, lost
  std::array<double, 2> extreme{};       // speed, temperature
  ExactSum speeds, volume;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (molten(i)) {
      ++count[0];
      speeds.add(speed(i));
      volume.add(p.volume[i]);
      extreme[0] = std::max(extreme[0], speed(i));
    }
    // What has left the domain keeps its temperature for ever.
    if (here(i) && p.phase[i] == Phase::lost) {
      ++count[1];
    } else if (here(i)) {
      extreme[1] = std::max(extreme[1], p.temperature[i]);
    }
  }
  ranks.add(count);
  ranks.largest(extreme);
  ranks.add(speeds);
  ranks.add(volume);
  line.mean_speed = count[0] > 0 ? speeds.total() / static_cast<double>(count[0]) : 0;
  line.liquid_volume = volume.total();
  line.lost_particles = count[1];
  line.largest_speed = extreme[0];
  line.peak_temperature = extreme[1];
}

/// The pool by both definitions, and clumping of the melt. On the root; elsewhere only its part.
void measure_pool(HistoryLine& line, const Engine& engine, double reference_temperature) {
  const Particles& local = engine.particles();
  const auto levels = [&](const Particles& p, std::size_t i) {
    return std::pair{p.temperature[i] - reference_temperature,
                     p.temperature[i] - engine.mixture().liquidus(p.concentration[i])};
  };
  // The pool is a small part of everything: only that, and what touches it, goes to the root.
  std::vector<std::uint8_t> warm(local.size(), 0);
  for (std::size_t i = 0; i < local.size(); ++i) {
    if (local.home[i] != Home::nowhere) {
      const auto [pool, liquid] = levels(local, i);
      warm[i] = pool >= 0 || liquid >= 0 || local.phase[i] == Phase::liquid ? 1 : 0;
    }
  }
  const Particles p = engine.collect(warm, touching * local.spacing);
  if (p.size() == 0) {
    return;
  }
  const PackedLists list = pack_neighbours(p, {}, touching * p.spacing);
  std::vector<double> pool(p.size()), liquid(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    std::tie(pool[i], liquid[i]) = levels(p, i);
    if (p.phase[i] == Phase::lost) {
      pool[i] = liquid[i] = nowhere;  // part of no pool
    }
  }
  line.pool = measure_extent(p, list, pool, true);
  line.any_liquid = measure_extent(p, list, liquid, false);
  line.clumped = engine.model().flow ? clumped_fraction(p) : 0;
}

}  // namespace

HistoryLine measure(const Engine& engine, double reference_temperature, double start_enthalpy) {
  HistoryLine line;
  line.time = engine.time();
  line.beam_x = engine.model().laser ? engine.model().laser->x(engine.time()) : 0;
  measure_pool(line, engine, reference_temperature);
  measure_melt(line, engine);
  line.absorbed_power = engine.beam().absorbed;
  line.absorbed = engine.ledger().absorbed;
  line.lost = engine.ledger().evaporated + engine.ledger().radiated + engine.ledger().convected;
  line.evaporated_mass = engine.ledger().evaporated_mass;
  line.enthalpy_change = engine.total_enthalpy() - start_enthalpy;
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

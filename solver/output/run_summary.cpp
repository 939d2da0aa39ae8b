// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/run_summary.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "base/progress.hpp"

namespace meltproof::solver {
namespace {

constexpr double pits = 130e-6;  // m, start-up of the prototype's tracks

double number(const nlohmann::json& result, const std::string& key) {
  return result.contains(key) && result[key].is_number() ? result[key].get<double>() : 0;
}

}  // namespace

double start_up_length(double track_length) { return std::min(pits, 0.4 * track_length); }

AcceptanceSettings track_acceptance(const Vector& lower, const Vector& upper, double track_length,
                                    double beam_radius) {
  AcceptanceSettings s;
  s.lower = lower;
  s.upper = upper;
  // Metal may stand and spatter above the layer; the engine takes it out half a millimetre higher.
  s.upper[2] += 0.5e-3;
  s.from = start_up_length(track_length);
  s.to = 0.8 * track_length;
  s.width = beam_radius;
  return s;
}

nlohmann::json timings_json(const Timings& timings) {
  nlohmann::json j = nlohmann::json::object();
  for (const auto& [part, seconds] : timings) {
    j[part + "_s"] = seconds;
  }
  return j;
}

std::string time_line(const Timings& timings, const Provenance& provenance, std::size_t steps) {
  double sum = 0;
  for (const auto& [part, seconds] : timings) {
    sum += seconds;
  }
  const double wall = std::max(provenance.wall_time, sum);
  std::string parts;
  for (const auto& [part, seconds] : timings) {
    if (seconds >= 1e-3 * wall) {
      parts +=
          fmt::format("{} {} ({:.0f} %), ", part, duration_text(seconds), 100 * seconds / wall);
    }
  }
  return fmt::format("time: {}other {}; in all {} on {} thread{}, {} steps", parts,
                     duration_text(wall - sum), duration_text(wall), provenance.threads,
                     provenance.threads == 1 ? "" : "s", steps);
}

std::string run_summary(const nlohmann::json& result, const Acceptance& acceptance,
                        const Timings& timings, const Provenance& provenance,
                        const std::filesystem::path& folder) {
  std::string out = fmt::format("{}\n", result.value("title", "run"));
  if (result.contains("steady_state")) {
    for (const auto& part : result["steady_state"]) {
      out += fmt::format("  {}\n", part.value("sentence", ""));
    }
  }
  out += fmt::format(
      "  energy closes to {:.1e}, additive mass to {:.1e}, the beam's power to {:.1e}\n",
      number(result, "energy_relative_error"), number(result, "species_relative_error"),
      number(result, "beam_balance_relative_error"));
  out += acceptance.table();
  out += fmt::format(
      "  {}\n", time_line(timings, provenance, static_cast<std::size_t>(number(result, "steps"))));
  out += fmt::format("  {} {}, revision {}", provenance.program, suite_version(), code_revision());
  for (const auto& [library, version] : provenance.libraries) {
    out += fmt::format(", {} {}", library, version);
  }
  out += fmt::format("\n  resolved input: {}; results: {}, history.csv, run.h5, run.xdmf\n",
                     (folder / "input.toml").string(), (folder / "result.json").string());
  return out;
}

void print_run_summary(const nlohmann::json& result, const Acceptance& acceptance,
                       const Timings& timings, const Provenance& provenance,
                       const std::filesystem::path& folder) {
  fmt::print("{}", run_summary(result, acceptance, timings, provenance, folder));
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// meltproof-bench: how fast whole steps of a track are, and what memory they need.
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <omp.h>

#include "base/atomic_file.hpp"
#include "base/program.hpp"
#include "base/provenance.hpp"
#include "base/units.hpp"
#include "solver/bench/stages.hpp"
#include "solver/particles/lanes.hpp"

namespace {

using namespace meltproof;

std::string about() {
  std::string text =
      "Measures whole steps of a track: lets its melt pool develop, then times the engine on one "
      "thread,\n"
      "as tracks run and with everything switched off that lets it pass over work. `make bench` "
      "calls it.\n"
      "Example: meltproof-bench solver/cases/track_0wt.toml --set powder.surface=bare --set "
      "spacing=\"14 um\" \\\n"
      "  --until \"150 us\" --output step.json\n"
      "Under mpirun it times the ranks together against one of them alone:\n"
      "mpirun -n 2 meltproof-bench ... --until \"60 us\" --output ranks.json\n"
      "A busy machine slows both down: believe the ratios of one run, and the spread.\n"
      "Stages:";
  for (const auto& stage : solver::bench_stages()) {
    text += fmt::format("\n  {}: {}", stage.name, stage.about);
  }
  return text;
}

/// A positive time in s. @throws InputError naming the option.
double positive_time(const std::string& option, const std::string& text) {
  const double value = parse_quantity(text, "s");
  if (!(value > 0)) {
    throw InputError(
        fmt::format("{} is \"{}\"; expected a time above zero, as \"10 us\"", option, text));
  }
  return value;
}

std::vector<solver::Stage> chosen(const std::vector<std::string>& names) {
  const auto& all = solver::bench_stages();
  for (const auto& name : names) {
    if (std::none_of(all.begin(), all.end(), [&](const auto& s) { return s.name == name; })) {
      throw InputError(fmt::format("--stage {}: there is no such stage; --help lists them", name));
    }
  }
  std::vector<solver::Stage> stages;
  for (const auto& stage : all) {
    if (names.empty() || std::find(names.begin(), names.end(), stage.name) != names.end()) {
      stages.push_back(stage);
    }
  }
  return stages;
}

}  // namespace

int main(int argc, char** argv) {
  const solver::MpiSession session;
  const solver::Ranks ranks = solver::Ranks::world();
  Program program("meltproof-bench", about());
  InputOptions options;
  options.add_to(program.app, "the track");
  std::string output, until = "150 us", window = "10 us";
  std::vector<std::string> stages;
  solver::BenchSettings settings;
  program.app.add_option("-o,--output", output, "file for the result (JSON)");
  program.app.add_option("--until", until, "simulated time at which the pool counts as developed")
      ->capture_default_str();
  program.app.add_option("--window", window, "simulated time of one repeat")->capture_default_str();
  program.app.add_option("--repeats", settings.repeats, "how often each is timed, in turns")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  program.app.add_option("--stage", stages, "only this stage; may be repeated");
  if (!ranks.root()) {
    program.hush();
  }
  const int status = program.run(argc, argv, [&] {
    solver::TrackCase track;
    Input input = solver::declare(track);
    if (!ranks.root() && options.only_asks()) {
      return ExitStatus::success;
    }
    if (options.handle(input)) {
      return ExitStatus::success;
    }
    if (output.empty()) {
      throw InputError("--output is missing: name the file for the result, for example step.json");
    }
    const double developed = positive_time("--until", until);
    settings.window = positive_time("--window", window);
    const auto selected = chosen(stages);
    if (developed + settings.repeats * settings.window > track.exposure) {
      throw InputError(fmt::format(
          "--until {} and {} repeats of {} are more than the beam's {:g} us; take less, or "
          "--set laser.exposure",
          until, settings.repeats, window, 1e6 * track.exposure));
    }
    // Speed per core is asked for; a stage that wants more sets its own.
    omp_set_num_threads(1);
    Provenance provenance = begin_provenance(argc, argv);
    provenance.resolved_input = input.resolved();
    for (const auto& file : input.files()) {
      provenance.add_input(file);
    }
    nlohmann::json result = {{"lanes", solver::lane_count},
                             {"figures", nlohmann::json::object()},
                             {"details", nlohmann::json::object()}};
    const auto keep = [&](const std::string& stage, const solver::StageResult& found) {
      for (const auto& figure : found.figures) {
        result["figures"][figure.key] = solver::figure_json(figure);
        if (!program.quiet()) {
          fmt::print("{}: {:.4g} {}\n", figure.key, solver::median(figure.repeats), figure.unit);
        }
      }
      result["details"][stage] = found.details;
    };
    if (ranks.alone()) {
      const solver::DevelopedPool pool = solver::develop_pool(track, developed);
      for (const auto& stage : selected) {
        keep(stage.name, stage.run(pool, settings));
      }
    } else {
      keep(fmt::format("ranks_{}", ranks.size()),
           solver::ranks_against_one(track, developed, settings, ranks));
      if (!ranks.root()) {
        return ExitStatus::success;
      }
    }
    provenance.wall_time = provenance.elapsed();
    result["provenance"] = provenance.json();
    write_file(output, result.dump(2) + "\n");
    return ExitStatus::success;
  });
  if (status != 0) {
    session.give_up(status);
  }
  return status;
}

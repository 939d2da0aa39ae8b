// SPDX-License-Identifier: GPL-3.0-or-later
// What meltproof-bench measures, a stage at a time. A new stage is a function here and a line in
// the table of stages.cpp.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "solver/bench/developed_pool.hpp"
#include "solver/bench/figure.hpp"

namespace meltproof::solver {

/// How long and how often to measure.
struct BenchSettings {
  double window = 10e-6;  ///< s of simulated time in one repeat
  int repeats = 5;
};

/// What a stage found.
struct StageResult {
  std::vector<Figure> figures;
  nlohmann::json details;  ///< an object; units in the keys
};

/// A stage by name.
struct Stage {
  std::string name;
  std::string about;  ///< half a sentence for --help
  StageResult (*run)(const DevelopedPool& pool, const BenchSettings& settings);
};

/// All stages in the order in which they run.
const std::vector<Stage>& bench_stages();

/// **Whole steps**: the engine as tracks run against the same engine with everything switched off
/// that lets it pass over work, and against one that gives all solid the passes of walls as well;
/// all on one thread from the same state, in turns, so that what else the machine does falls on all.
StageResult whole_step_stage(const DevelopedPool& pool, const BenchSettings& settings);

/// The model, and the state to begin from, with which no pass leaves out a particle that it could
/// concern: heat among all particles, lists of all particles made anew whenever any are, and one
/// acoustic step in a thermal one.
struct NothingSkipped {
  Model model;
  EngineState state;
};
NothingSkipped skip_nothing(const DevelopedPool& pool);

/// **Several ranks against one**: the same simulated time by all ranks together and by the root
/// alone while the others wait, in turns, from the same state. Collective; the root's result
/// counts. The key of the figure is ranks_<number>_over_1.
/// @param until simulated time at which the pool counts as developed, s, reached on all ranks.
StageResult ranks_against_one(const TrackCase& track, double until, const BenchSettings& settings,
                              const Ranks& ranks);

}  // namespace meltproof::solver

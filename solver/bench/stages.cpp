// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/bench/stages.hpp"

namespace meltproof::solver {

const std::vector<Stage>& bench_stages() {
  static const std::vector<Stage> stages = {
      {"step", "whole steps with and without active sets and multirate, and their parts",
       &whole_step_stage},
  };
  return stages;
}

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
// One measured figure with its repeats, and how much memory the program holds.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace meltproof::solver {

/// A figure of `make bench`. What is asked of it stands in pipelines/bench.toml, by its key.
struct Figure {
  std::string key;              ///< as in bench.json
  std::string unit;             ///< "1" for a ratio
  std::string how;              ///< one sentence: what was measured
  std::vector<double> repeats;  ///< at least one, in the order in which they were measured
};

/// The middle value; of an even number the mean of the two in the middle. @param values at least
/// one.
double median(std::vector<double> values);

/// {"value": the median, "unit", "how", "min", "median", "max", "repeats"}.
nlohmann::json figure_json(const Figure& figure);

/// Memory of this program that the machine holds, bytes, from /proc/self/status; zero on a system
/// that has none.
struct ResidentMemory {
  double now = 0;   ///< at this moment
  double peak = 0;  ///< the most since the program began
};
ResidentMemory resident_memory();

}  // namespace meltproof::solver

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/bench/figure.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace meltproof::solver {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values.at(middle)
                                : (values.at(middle - 1) + values.at(middle)) / 2;
}

nlohmann::json figure_json(const Figure& figure) {
  const double middle = median(figure.repeats);
  return {{"value", middle},
          {"unit", figure.unit},
          {"how", figure.how},
          {"min", *std::min_element(figure.repeats.begin(), figure.repeats.end())},
          {"median", middle},
          {"max", *std::max_element(figure.repeats.begin(), figure.repeats.end())},
          {"repeats", figure.repeats}};
}

ResidentMemory resident_memory() {
  ResidentMemory memory;
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    std::istringstream words(line);
    std::string name;
    double kibibytes = 0;
    words >> name >> kibibytes;
    if (name == "VmRSS:") {
      memory.now = 1024 * kibibytes;
    } else if (name == "VmHWM:") {
      memory.peak = 1024 * kibibytes;
    }
  }
  return memory;
}

}  // namespace meltproof::solver

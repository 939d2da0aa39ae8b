// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>

namespace meltproof::solver {

/// Wall-clock time in seconds, added up by lap: each goes to the part of the step that it names.
class Stopwatch {
 public:
  void lap(double& sum) {
    const auto now = std::chrono::steady_clock::now();
    sum += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace meltproof::solver

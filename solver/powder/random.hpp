// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers that are the same with every standard library: the engine is fixed by the C++
// standard, its distributions are not, so the transforms stand here.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace meltproof::solver {

/// A stream of random numbers from a seed.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  /// Uniform in [0, 1): the upper 53 bits of the engine's next word.
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  /// Standard normal (Box and Muller 1958): the cosine branch of two uniform numbers; the sine
  /// branch is left unused so that each call takes exactly two words.
  double normal() {
    const double u = 1 - uniform();  // in (0, 1], so that its logarithm exists
    const double v = uniform();
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace meltproof::solver

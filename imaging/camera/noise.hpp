// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers whose bits do not depend on the standard library: its distributions may differ
// between implementations, its engine may not.
#pragma once

#include <cstdint>
#include <random>

namespace meltproof::imaging {

/// A stated seed and what is drawn from it, in a stated way.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : engine_(seed) {}
  /// Uniform in the open interval (0, 1): the upper 53 bits of one draw of mt19937_64, plus a half,
  /// times 2^-53.
  double uniform();
  /// Standard normal by the transform of Box and Muller (1958); the pair's second number is kept
  /// for the next call.
  double normal();

 private:
  std::mt19937_64 engine_;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace meltproof::imaging

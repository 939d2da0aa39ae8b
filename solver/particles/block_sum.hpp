// SPDX-License-Identifier: GPL-3.0-or-later
// Sums and extremes over particles that do not depend on the number of threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace meltproof::solver {

/// Runs body(i) for i < n on all threads; small loops stay on one, where starting threads costs
/// more.
template <class Body>
void for_each_particle(std::size_t n, const Body& body) {
  const auto count = static_cast<std::int64_t>(n);
#pragma omp parallel for schedule(dynamic, 256) if (count > 2000)
  for (std::int64_t i = 0; i < count; ++i) {
    body(static_cast<std::size_t>(i));
  }
}

/// The sum of value(i) for i < n: blocks of 256 in order, then the blocks in order, whatever the
/// threads.
template <class Value>
double block_sum(std::size_t n, const Value& value) {
  constexpr std::size_t block = 256;
  const std::size_t blocks = (n + block - 1) / block;
  std::vector<double> part(blocks);
  for (std::size_t b = 0; b < blocks; ++b) {
    double sum = 0;
    for (std::size_t i = b * block; i < std::min(n, (b + 1) * block); ++i) {
      sum += value(i);
    }
    part[b] = sum;
  }
  double sum = 0;
  for (const double p : part) {
    sum += p;
  }
  return sum;
}

/// The largest value(i) for i < n, or `least` if n is zero.
template <class Value>
double block_max(std::size_t n, double least, const Value& value) {
  double result = least;
  for (std::size_t i = 0; i < n; ++i) {
    result = std::max(result, value(i));
  }
  return result;
}

}  // namespace meltproof::solver

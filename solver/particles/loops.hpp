// SPDX-License-Identifier: GPL-3.0-or-later
// Loops over particles whose result does not depend on the number of threads; sums are in
// exact_sum.hpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace meltproof::solver {

/// Runs body(i) for i < n on all threads, `chunk` at a time; up to `few` of them stay on one
/// thread, because starting threads takes a few microseconds.
template <class Body>
void for_each_in_chunks(std::size_t n, int chunk, std::int64_t few, const Body& body) {
  const auto count = static_cast<std::int64_t>(n);
#pragma omp parallel for schedule(dynamic, chunk) if (count > few)
  for (std::int64_t i = 0; i < count; ++i) {
    body(static_cast<std::size_t>(i));
  }
}

/// The same for bodies of some nanoseconds.
template <class Body>
void for_each_particle(std::size_t n, const Body& body) {
  for_each_in_chunks(n, 256, 2000, body);
}

/// The same for bodies that take a fraction of a microsecond, as sums over neighbours do.
template <class Body>
void for_each_sum(std::size_t n, const Body& body) {
  for_each_in_chunks(n, 16, 64, body);
}

/// The largest value(i) for i < n, or `least` if n is zero, on all threads.
template <class Value>
double block_max(std::size_t n, double least, const Value& value) {
  double result = least;
  const auto count = static_cast<std::int64_t>(n);
#pragma omp parallel for schedule(static) reduction(max : result) if (count > 2000)
  for (std::int64_t i = 0; i < count; ++i) {
    result = std::max<double>(result, value(static_cast<std::size_t>(i)));
  }
  return result;
}

/// Those i < n for which test(i) holds, in order, on all threads.
template <class Test>
void select_indices(std::size_t n, const Test& test, std::vector<std::uint32_t>& chosen) {
  constexpr std::size_t block = 65536;
  std::vector<std::vector<std::uint32_t>> parts((n + block - 1) / block);
  for_each_in_chunks(parts.size(), 1, 1, [&](std::size_t b) {
    const auto end = static_cast<std::uint32_t>(std::min(n, (b + 1) * block));
    for (auto i = static_cast<std::uint32_t>(b * block); i < end; ++i) {
      if (test(i)) {
        parts[b].push_back(i);
      }
    }
  });
  chosen.clear();
  for (const auto& part : parts) {
    chosen.insert(chosen.end(), part.begin(), part.end());
  }
}

}  // namespace meltproof::solver

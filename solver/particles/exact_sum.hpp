// SPDX-License-Identifier: GPL-3.0-or-later
// A sum that is the same in any order, and so on any number of threads and ranks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace meltproof::solver {

/// **Sum without rounding**: a fixed-point number wide enough for every double, in limbs of 32 bits
/// kept in 64 (a long accumulator after Kulisch). Integers may be added in any order, so partial
/// sums of threads and ranks join to the same total; it is rounded once, when it is asked for.
/// Up to 2^31 numbers; one that is infinite or no number makes the total no number.
class ExactSum {
 public:
  /// 2098 bits from the smallest subnormal to the largest double, a limb for carries, and one that
  /// counts what is not finite.
  static constexpr std::size_t limb_count = 68;

  void add(double value);
  void add(const ExactSum& other);
  /// The exact sum, rounded to the nearest double but for ties and the last bit of a limb: the
  /// error is below 2^-52 of it.
  double total() const;

  /// For exchange between ranks: sums of limbs are sums of numbers.
  const std::array<std::int64_t, limb_count>& limbs() const { return limb_; }
  std::array<std::int64_t, limb_count>& limbs() { return limb_; }

 private:
  std::array<std::int64_t, limb_count> limb_{};
};

/// The exact sum of value(i) for i < n.
template <class Value>
ExactSum exact_sum(std::size_t n, const Value& value) {
  ExactSum sum;
  for (std::size_t i = 0; i < n; ++i) {
    sum.add(value(i));
  }
  return sum;
}

}  // namespace meltproof::solver

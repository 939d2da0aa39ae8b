// SPDX-License-Identifier: GPL-3.0-or-later
// The only file that knows SIMD: what a pair function sees is a number type with arithmetic, sqrt
// and max, which is `double` in tests and `Lane` in the loops.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <experimental/simd>

namespace meltproof::solver {

/// As many doubles as the processor handles at once.
using Lane = std::experimental::native_simd<double>;
inline constexpr std::size_t lane_count = Lane::size();

inline double positive_part(double value) { return value > 0 ? value : 0; }
[[gnu::always_inline]] inline Lane positive_part(const Lane& value) { return std::experimental::max(value, Lane(0.0)); }
inline double larger(double a, double b) { return a > b ? a : b; }
[[gnu::always_inline]] inline Lane larger(const Lane& a, const Lane& b) { return std::experimental::max(a, b); }
inline double smaller(double a, double b) { return a < b ? a : b; }
[[gnu::always_inline]] inline Lane smaller(const Lane& a, const Lane& b) { return std::experimental::min(a, b); }
inline double square_root(double value) { return std::sqrt(value); }
[[gnu::always_inline]] inline Lane square_root(const Lane& value) { return std::experimental::sqrt(value); }

/// `value` where `test` is positive, `other` elsewhere.
inline double where_positive(double test, double value, double other) {
  return test > 0 ? value : other;
}
[[gnu::always_inline]] inline Lane where_positive(const Lane& test, const Lane& value, const Lane& other) {
  Lane result = other;
  std::experimental::where(test > 0.0, result) = value;
  return result;
}

/// The sum over the lanes, always in the same order.
inline double sum_lanes(const Lane& value) {
  double sum = 0;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    sum += value[lane];
  }
  return sum;
}

/// One field of the records that `index` names, one record a lane.
template <class Record>
[[gnu::always_inline]] inline Lane gather(const Record* records, const std::uint32_t* index, double Record::*field) {
  return Lane([&](auto lane) { return records[index[lane]].*field; });
}

}  // namespace meltproof::solver

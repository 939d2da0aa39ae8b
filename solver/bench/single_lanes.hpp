// SPDX-License-Identifier: GPL-3.0-or-later
// Lanes of single precision, twice as many as of double: an experiment of the benchmarks, beside
// particles/lanes.hpp, which is what the solver uses.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "solver/particles/lanes.hpp"

namespace meltproof::solver {

/// As many floats as the processor handles at once. Takes doubles as they come, so that the pair
/// functions need not know of it: their constants are rounded once.
class SingleLane {
 public:
  using Simd = std::experimental::native_simd<float>;

  SingleLane() = default;
  SingleLane(double everywhere) : value_(static_cast<float>(everywhere)) {}  // NOLINT: as a double
  explicit SingleLane(const Simd& value) : value_(value) {}
  const Simd& value() const { return value_; }

  [[gnu::always_inline]] friend SingleLane operator+(const SingleLane& a, const SingleLane& b) {
    return SingleLane(Simd(a.value_ + b.value_));
  }
  [[gnu::always_inline]] friend SingleLane operator-(const SingleLane& a, const SingleLane& b) {
    return SingleLane(Simd(a.value_ - b.value_));
  }
  [[gnu::always_inline]] friend SingleLane operator*(const SingleLane& a, const SingleLane& b) {
    return SingleLane(Simd(a.value_ * b.value_));
  }
  [[gnu::always_inline]] friend SingleLane operator/(const SingleLane& a, const SingleLane& b) {
    return SingleLane(Simd(a.value_ / b.value_));
  }
  [[gnu::always_inline]] SingleLane& operator+=(const SingleLane& b) {
    value_ += b.value_;
    return *this;
  }

 private:
  Simd value_ = 0.0F;
};

inline constexpr std::size_t single_count = SingleLane::Simd::size();

[[gnu::always_inline]] inline SingleLane positive_part(const SingleLane& value) {
  return SingleLane(std::experimental::max(value.value(), SingleLane::Simd(0.0F)));
}
[[gnu::always_inline]] inline SingleLane larger(const SingleLane& a, const SingleLane& b) {
  return SingleLane(std::experimental::max(a.value(), b.value()));
}
[[gnu::always_inline]] inline SingleLane square_root(const SingleLane& value) {
  return SingleLane(SingleLane::Simd(std::experimental::sqrt(value.value())));
}

/// The sum over the lanes, always in the same order, in double precision: the halves first, lane by
/// lane.
inline double sum_lanes(const SingleLane& value) {
  static_assert(single_count == 2 * lane_count);
  using Half = lanes_detail::Row<float, lane_count>;
  using Double = lanes_detail::Row<double, lane_count>;
  const auto half = std::bit_cast<std::array<Half, 2>>(value);
  return sum_lanes(std::bit_cast<Lane>(__builtin_convertvector(half[0], Double) +
                                       __builtin_convertvector(half[1], Double)));
}

/// All fields of the records of floats that `index` names, one record a lane; see gather_records().
template <template <class> class Fields>
[[gnu::always_inline]] inline Fields<SingleLane> gather_single(const Fields<float>* records,
                                                               const std::uint32_t* index) {
  constexpr std::size_t count = sizeof(Fields<float>) / sizeof(float);
  static_assert(
      count % single_count == 0 && sizeof(Fields<SingleLane>) == count * sizeof(SingleLane),
      "a record is filled up to sixteen floats or a multiple");
  using Row = lanes_detail::Row<float, single_count>;
  std::array<Row, count> columns;
  for (std::size_t block = 0; block < count; block += single_count) {
    Row rows[single_count];
    for (std::size_t lane = 0; lane < single_count; ++lane) {
      const char* from = reinterpret_cast<const char*>(records + index[lane]);
      std::memcpy(&rows[lane], from + block * sizeof(float), sizeof(rows[lane]));
    }
    lanes_detail::transpose<float, single_count>(rows);
    for (std::size_t field = 0; field < single_count; ++field) {
      columns[block + field] = rows[field];
    }
  }
  return std::bit_cast<Fields<SingleLane>>(columns);
}

/// A number in fixed point, as whole steps: the difference of two is exact however large they are,
/// and rounds only when it becomes a float. Kept where a record has a float.
inline float fixed_point(double value, double step) {
  const auto steps = static_cast<std::int64_t>(value / step + (value < 0 ? -0.5 : 0.5));
  return std::bit_cast<float>(static_cast<std::uint32_t>(steps));
}

/// other - own in steps, of numbers in fixed point; beyond half the range it wraps around.
[[gnu::always_inline]] inline SingleLane fixed_steps(float own, const SingleLane& other) {
  using Unsigned = lanes_detail::Row<std::uint32_t, single_count>;
  using Signed = lanes_detail::Row<std::int32_t, single_count>;
  using Float = lanes_detail::Row<float, single_count>;
  // Unsigned, because there wrapping around is defined.
  const Unsigned steps = std::bit_cast<Unsigned>(other) - std::bit_cast<std::uint32_t>(own);
  const Float difference = __builtin_convertvector(std::bit_cast<Signed>(steps), Float);
  return std::bit_cast<SingleLane>(difference);
}

/// own - other in units.
[[gnu::always_inline]] inline SingleLane fixed_difference(float own, const SingleLane& other,
                                                          double step) {
  return fixed_steps(own, other) * SingleLane(-step);
}

}  // namespace meltproof::solver

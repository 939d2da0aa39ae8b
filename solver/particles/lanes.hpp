// SPDX-License-Identifier: GPL-3.0-or-later
// The only file that knows SIMD: what a pair function sees is a number type with arithmetic, sqrt
// and max, which is `double` in tests and `Lane` in the loops.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

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

namespace lanes_detail {

/// As many doubles as a lane holds, as the compiler knows them: it can shuffle them.
template <std::size_t Count>
struct VectorOf {
  using Type [[gnu::vector_size(sizeof(double) * Count)]] = double;
};
template <std::size_t Count>
using Row = typename VectorOf<Count>::Type;

/// Rows become columns.
template <std::size_t Count>
[[gnu::always_inline]] inline void transpose(std::array<Row<Count>, Count>& row) {
  if constexpr (Count == 8) {
    std::array<Row<Count>, 8> pair, four;
    for (std::size_t i = 0; i < 8; i += 2) {
      pair[i] = __builtin_shufflevector(row[i], row[i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
      pair[i + 1] = __builtin_shufflevector(row[i], row[i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
    }
    for (std::size_t i : {0, 1, 4, 5}) {
      four[i] = __builtin_shufflevector(pair[i], pair[i + 2], 0, 1, 8, 9, 4, 5, 12, 13);
      four[i + 2] = __builtin_shufflevector(pair[i], pair[i + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      row[i] = __builtin_shufflevector(four[i], four[i + 4], 0, 1, 2, 3, 8, 9, 10, 11);
      row[i + 4] = __builtin_shufflevector(four[i], four[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
    }
  } else if constexpr (Count == 4) {
    std::array<Row<Count>, 4> pair;
    for (std::size_t i = 0; i < 4; i += 2) {
      pair[i] = __builtin_shufflevector(row[i], row[i + 1], 0, 4, 2, 6);
      pair[i + 1] = __builtin_shufflevector(row[i], row[i + 1], 1, 5, 3, 7);
    }
    for (std::size_t i = 0; i < 2; ++i) {
      row[i] = __builtin_shufflevector(pair[i], pair[i + 2], 0, 1, 4, 5);
      row[i + 2] = __builtin_shufflevector(pair[i], pair[i + 2], 2, 3, 6, 7);
    }
  } else {
    const std::array<Row<Count>, Count> old = row;
    for (std::size_t i = 0; i < Count; ++i) {
      for (std::size_t k = 0; k < Count; ++k) {
        row[i][k] = old[k][i];
      }
    }
  }
}

}  // namespace lanes_detail

/// **All fields of the records that `index` names**, one record a lane. A record is a template over
/// its number type, filled up to eight doubles or a multiple; what comes back is the same record of
/// lanes. Whole records are read and rows turned into columns; in the pair loop of bench/ that takes
/// 0.85 of the time of collecting field by field (eight lanes). The numbers are the same.
template <template <class> class Fields>
[[gnu::always_inline]] inline Fields<Lane> gather_records(const Fields<double>* records,
                                                          const std::uint32_t* index) {
  constexpr std::size_t count = sizeof(Fields<double>) / sizeof(double);
  static_assert(count % lane_count == 0 && sizeof(Fields<Lane>) == lane_count * sizeof(Fields<double>),
                "a record is filled up to eight doubles or a multiple");
  using Row = lanes_detail::Row<lane_count>;
  std::array<Row, count> columns;
  for (std::size_t block = 0; block < count; block += lane_count) {
    std::array<Row, lane_count> rows;
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const char* from = reinterpret_cast<const char*>(records + index[lane]);
      std::memcpy(&rows[lane], from + block * sizeof(double), sizeof(rows[lane]));
    }
    lanes_detail::transpose<lane_count>(rows);
    for (std::size_t field = 0; field < lane_count; ++field) {
      columns[block + field] = rows[field];
    }
  }
  return std::bit_cast<Fields<Lane>>(columns);
}

}  // namespace meltproof::solver

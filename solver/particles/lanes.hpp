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
#include <utility>
#include <vector>

#include <experimental/simd>

#if defined(__AVX512F__) && defined(__AVX512VL__)
#include <immintrin.h>
#endif

namespace meltproof::solver {

/// As many doubles as the processor handles at once.
using Lane = std::experimental::native_simd<double>;
inline constexpr std::size_t lane_count = Lane::size();

inline double positive_part(double value) { return value > 0 ? value : 0; }
[[gnu::always_inline]] inline Lane positive_part(const Lane& value) {
  return std::experimental::max(value, Lane(0.0));
}
inline double larger(double a, double b) { return a > b ? a : b; }
[[gnu::always_inline]] inline Lane larger(const Lane& a, const Lane& b) {
  return std::experimental::max(a, b);
}
inline double smaller(double a, double b) { return a < b ? a : b; }
[[gnu::always_inline]] inline Lane smaller(const Lane& a, const Lane& b) {
  return std::experimental::min(a, b);
}
inline double square_root(double value) { return std::sqrt(value); }
[[gnu::always_inline]] inline Lane square_root(const Lane& value) {
  return std::experimental::sqrt(value);
}

/// `value` where `test` is positive, `other` elsewhere.
inline double where_positive(double test, double value, double other) {
  return test > 0 ? value : other;
}
[[gnu::always_inline]] inline Lane where_positive(const Lane& test, const Lane& value,
                                                  const Lane& other) {
  Lane result = other;
  std::experimental::where(test > 0.0, result) = value;
  return result;
}

/// Whether a comparison holds in any lane.
[[gnu::always_inline]] inline bool any_of(const Lane::mask_type& test) {
  return std::experimental::any_of(test);
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
[[gnu::always_inline]] inline Lane gather(const Record* records, const std::uint32_t* index,
                                          double Record::*field) {
  return Lane([&](auto lane) { return records[index[lane]].*field; });
}

/// Coordinates apart, with room behind the last one: as candidates_within() reads them.
struct Coordinates {
  std::vector<double> x, y, z;
};

/// **Of n candidates, in their order, those nearer to a point than the larger of two limits**:
/// writes their `index` to `out` and returns how many.
/// @param at x, y, z, m; @param own_limit, limit of the point and of each candidate, m2; @param
/// self an index that is left out; @param out with room for n and one pack of 8 more.
inline std::size_t candidates_within(const std::array<double, 3>& at, double own_limit,
                                     const Coordinates& place, const double* limit,
                                     const std::uint32_t* index, std::size_t n, std::uint32_t self,
                                     std::uint32_t* out) {
  std::size_t end = 0, k = 0;
#if defined(__AVX512F__) && defined(__AVX512VL__)
  const __m512d ax = _mm512_set1_pd(at[0]), ay = _mm512_set1_pd(at[1]), az = _mm512_set1_pd(at[2]);
  const __m512d own = _mm512_set1_pd(own_limit);
  const __m256i no = _mm256_set1_epi32(static_cast<int>(self));
  for (; k + 8 <= n; k += 8) {
    const __m512d dx = _mm512_sub_pd(ax, _mm512_loadu_pd(place.x.data() + k));
    const __m512d dy = _mm512_sub_pd(ay, _mm512_loadu_pd(place.y.data() + k));
    const __m512d dz = _mm512_sub_pd(az, _mm512_loadu_pd(place.z.data() + k));
    const __m512d squared = _mm512_add_pd(
        _mm512_add_pd(_mm512_mul_pd(dx, dx), _mm512_mul_pd(dy, dy)), _mm512_mul_pd(dz, dz));
    const __m256i who = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(index + k));
    const __mmask8 near =
        _mm512_cmp_pd_mask(squared, _mm512_max_pd(own, _mm512_loadu_pd(limit + k)), _CMP_LT_OQ);
    const __mmask8 keep = near & _mm256_cmpneq_epi32_mask(who, no);
    // Pushed together in a register: the processor's own compressing store is slow.
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out + end),
                        _mm256_maskz_compress_epi32(keep, who));
    end += static_cast<std::size_t>(std::popcount(static_cast<unsigned>(keep)));
  }
#endif
  for (; k < n; ++k) {
    const double dx = at[0] - place.x[k], dy = at[1] - place.y[k], dz = at[2] - place.z[k];
    // Written always and counted if it belongs there: no branch to be guessed wrong.
    out[end] = index[k];
    end += dx * dx + dy * dy + dz * dz < larger(own_limit, limit[k]) && index[k] != self ? 1U : 0U;
  }
  return end;
}

namespace lanes_detail {

/// `Count` numbers as the compiler knows them: it can shuffle them.
template <class Number, std::size_t Count>
struct VectorOf {
  using Type [[gnu::vector_size(sizeof(Number) * Count)]] = Number;
};
template <class Number, std::size_t Count>
using Row = typename VectorOf<Number, Count>::Type;

/// Numbers in 128 bits: what the processor interleaves in one cycle, without a table of places.
template <class Number>
inline constexpr std::size_t block_of = 16 / sizeof(Number);

/// Of two rows the first (`Upper` 0) or second halves of each block of 128 bits, in turns and in
/// parts of `Part` numbers.
template <std::size_t Upper, std::size_t Part, class Number, class Vector, std::size_t... To>
[[gnu::always_inline]] inline Vector interleave(const Vector& a, const Vector& b,
                                                std::index_sequence<To...>) {
  constexpr std::size_t count = sizeof...(To), block = block_of<Number>;
  return __builtin_shufflevector(
      a, b,
      (To / block * block + Upper * (block / 2) + To % block / (2 * Part) * Part + To % Part +
       (To / Part % 2 != 0 ? count : 0))...);
}

/// Of two rows the even (`Odd` 0) or odd blocks of 128 bits, a's before b's.
template <std::size_t Odd, class Number, class Vector, std::size_t... To>
[[gnu::always_inline]] inline Vector every_other_block(const Vector& a, const Vector& b,
                                                       std::index_sequence<To...>) {
  constexpr std::size_t block = block_of<Number>;
  return __builtin_shufflevector(a, b, ((2 * (To / block) + Odd) * block + To % block)...);
}

/// **Rows become columns.** First within blocks of 128 bits, by interleaving numbers, then the
/// blocks among each other; both are single instructions without a table, unlike exchanging blocks
/// of two across all of a register.
template <class Number, std::size_t Count>
[[gnu::always_inline]] inline void transpose(Row<Number, Count> (&row)[Count]) {
  constexpr std::size_t block = block_of<Number>;
  constexpr auto to = std::make_index_sequence<Count>{};
#pragma GCC unroll 16
  for (std::size_t i = 0; i < Count; i += block) {
    Row<Number, Count>* r = row + i;
    if constexpr (block == 2) {
      const auto a = r[0];
      r[0] = interleave<0, 1, Number>(a, r[1], to);
      r[1] = interleave<1, 1, Number>(a, r[1], to);
    } else {
      const auto a = interleave<0, 1, Number>(r[0], r[1], to);
      const auto b = interleave<1, 1, Number>(r[0], r[1], to);
      const auto c = interleave<0, 1, Number>(r[2], r[3], to);
      const auto d = interleave<1, 1, Number>(r[2], r[3], to);
      r[0] = interleave<0, 2, Number>(a, c, to);
      r[1] = interleave<1, 2, Number>(a, c, to);
      r[2] = interleave<0, 2, Number>(b, d, to);
      r[3] = interleave<1, 2, Number>(b, d, to);
    }
  }
#pragma GCC unroll 16
  for (std::size_t i = 0; i < block; ++i) {
    Row<Number, Count>* r = row + i;
    if constexpr (Count == 2 * block) {
      const auto a = r[0];
      r[0] = every_other_block<0, Number>(a, r[block], to);
      r[block] = every_other_block<1, Number>(a, r[block], to);
    } else if constexpr (Count == 4 * block) {
      const auto a = every_other_block<0, Number>(r[0], r[block], to);
      const auto b = every_other_block<1, Number>(r[0], r[block], to);
      const auto c = every_other_block<0, Number>(r[2 * block], r[3 * block], to);
      const auto d = every_other_block<1, Number>(r[2 * block], r[3 * block], to);
      r[0] = every_other_block<0, Number>(a, c, to);
      r[block] = every_other_block<0, Number>(b, d, to);
      r[2 * block] = every_other_block<1, Number>(a, c, to);
      r[3 * block] = every_other_block<1, Number>(b, d, to);
    }
  }
}

}  // namespace lanes_detail

/// **All fields of the records that `index` names**, one record a lane. A record is a template over
/// its number type, filled up to eight doubles or a multiple; what comes back is the same record of
/// lanes. Whole records are read and rows turned into columns; in the pair loop of bench/ that
/// takes 0.85 of the time of collecting field by field (eight lanes). The numbers are the same.
template <template <class> class Fields>
[[gnu::always_inline]] inline Fields<Lane> gather_records(const Fields<double>* records,
                                                          const std::uint32_t* index) {
  constexpr std::size_t count = sizeof(Fields<double>) / sizeof(double);
  static_assert(
      count % lane_count == 0 && sizeof(Fields<Lane>) == lane_count * sizeof(Fields<double>),
      "a record is filled up to eight doubles or a multiple");
  using Row = lanes_detail::Row<double, lane_count>;
  std::array<Row, count> columns;
  for (std::size_t block = 0; block < count; block += lane_count) {
    Row rows[lane_count];
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const char* from = reinterpret_cast<const char*>(records + index[lane]);
      std::memcpy(&rows[lane], from + block * sizeof(double), sizeof(rows[lane]));
    }
    lanes_detail::transpose<double, lane_count>(rows);
    for (std::size_t field = 0; field < lane_count; ++field) {
      columns[block + field] = rows[field];
    }
  }
  return std::bit_cast<Fields<Lane>>(columns);
}

}  // namespace meltproof::solver

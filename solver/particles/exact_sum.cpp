// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/particles/exact_sum.hpp"

#include <bit>
#include <cmath>
#include <limits>

namespace meltproof::solver {
namespace {

constexpr std::uint64_t low_bits = 0xffffffff;
constexpr std::size_t not_finite = ExactSum::limb_count - 1;

}  // namespace

void ExactSum::add(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const auto exponent = static_cast<std::uint32_t>(bits >> 52U & 0x7ffU);
  std::uint64_t mantissa = bits & 0xfffffffffffffU;
  if (exponent == 0x7ffU) {
    ++limb_[not_finite];
    return;
  }
  // Bit 0 of limb 0 is the smallest subnormal; those have no leading one.
  const std::uint32_t place = exponent == 0 ? 0 : exponent - 1;
  mantissa |= exponent == 0 ? 0 : std::uint64_t{1} << 52U;
  const std::size_t first = place / 32;
  const std::uint32_t shift = place % 32;
  const std::uint64_t low = mantissa << shift;
  const std::uint64_t high = shift == 0 ? 0 : mantissa >> (64 - shift);
  const std::int64_t sign = bits >> 63U != 0 ? -1 : 1;
  limb_[first] += sign * static_cast<std::int64_t>(low & low_bits);
  limb_[first + 1] += sign * static_cast<std::int64_t>(low >> 32U);
  limb_[first + 2] += sign * static_cast<std::int64_t>(high);
}

void ExactSum::add(const ExactSum& other) {
  for (std::size_t k = 0; k < limb_count; ++k) {
    limb_[k] += other.limb_[k];
  }
}

double ExactSum::total() const {
  if (limb_[not_finite] != 0) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  // Carries upward, so that each limb holds 32 bits and the topmost the sign.
  std::array<std::int64_t, limb_count> limb = limb_;
  for (std::size_t k = 0; k + 2 < limb_count; ++k) {
    const std::int64_t low = limb[k] & static_cast<std::int64_t>(low_bits);
    limb[k + 1] += (limb[k] - low) >> 32;
    limb[k] = low;
  }
  const bool negative = limb[limb_count - 2] < 0;
  if (negative) {
    // The magnitude: a sum of signed limbs would cancel digit by digit.
    std::int64_t carry = 0;
    for (std::size_t k = 0; k + 1 < limb_count; ++k) {
      const std::int64_t value = -limb[k] + carry;
      const std::int64_t low = value & static_cast<std::int64_t>(low_bits);
      carry = (value - low) >> 32;
      limb[k] = low;
    }
  }
  // The three topmost limbs that hold anything have at least 65 significant bits.
  double sum = 0;
  std::size_t used = 0;
  for (std::size_t k = limb_count - 1; k-- > 0 && used < 3;) {
    if (limb[k] != 0 || used > 0) {
      sum += std::ldexp(static_cast<double>(limb[k]), 32 * static_cast<int>(k) - 1074);
      ++used;
    }
  }
  return negative ? -sum : sum;
}

}  // namespace meltproof::solver

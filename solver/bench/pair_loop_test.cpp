// SPDX-License-Identifier: GPL-3.0-or-later
// The pair loop that is timed computes what it claims to.
#include "solver/bench/pair_loop.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "solver/bench/figure.hpp"
#include "solver/bench/pair_block.hpp"
#include "solver/bench/single_loop.hpp"

namespace meltproof::solver {
namespace {

std::array<double, 6> numbers(const PairRates& r) {
  return {r.density, r.fx, r.fy, r.fz, r.power, r.concentration};
}

std::vector<PairRates> scalar_rates(const PairBlock& block) {
  std::vector<PairRates> rates(block.size());
  five_terms<double>(block.records, block.list, block.kernel, rates);
  return rates;
}

}  // namespace

// All widths, those too that the lanes of this machine do not have.
template <class Number, std::size_t Count>
void expect_transposed() {
  lanes_detail::Row<Number, Count> rows[Count];
  for (std::size_t i = 0; i < Count; ++i) {
    for (std::size_t k = 0; k < Count; ++k) {
      rows[i][k] = static_cast<Number>(100 * i + k);
    }
  }
  lanes_detail::transpose<Number, Count>(rows);
  for (std::size_t i = 0; i < Count; ++i) {
    for (std::size_t k = 0; k < Count; ++k) {
      EXPECT_EQ(rows[i][k], static_cast<Number>(100 * k + i)) << Count << " " << i << " " << k;
    }
  }
}

TEST(Lanes, RowsBecomeColumns) {
  expect_transposed<double, 2>();
  expect_transposed<double, 4>();
  expect_transposed<double, 8>();
  expect_transposed<float, 4>();
  expect_transposed<float, 8>();
  expect_transposed<float, 16>();
}

// Lanes add the same summands in another order: sums differ by round-off of the largest, never
// more.
TEST(PairLoop, LanesAndScalarsAgreeToRoundOff) {
  const PairBlock block = make_pair_block(14);
  const std::vector<PairRates> scalar = scalar_rates(block);
  std::vector<PairRates> lanes(block.size());
  five_terms<Lane>(block.records, block.list, block.kernel, lanes);
  std::array<double, 6> largest{}, off{};
  for (std::size_t i = 0; i < block.size(); ++i) {
    const auto a = numbers(scalar[i]), b = numbers(lanes[i]);
    for (std::size_t k = 0; k < a.size(); ++k) {
      ASSERT_TRUE(std::isfinite(a[k]));
      largest[k] = std::max(largest[k], std::abs(a[k]));
      off[k] = std::max(off[k], std::abs(a[k] - b[k]));
    }
  }
  for (std::size_t k = 0; k < largest.size(); ++k) {
    EXPECT_GT(largest[k], 0) << k;
    // A hundred summands, each rounded to 1e-16.
    EXPECT_LT(off[k], 1e-13 * largest[k]) << k;
  }
}

// Single precision has 24 bits: 6e-8 of each summand. Places in fixed point keep that wherever the
// block lies and however far its particles are from its middle.
TEST(PairLoop, SinglePrecisionDiffersByItsOwnRoundOffOnly) {
  PairBlock block = make_pair_block(14);
  const std::vector<PairRates> exact = scalar_rates(block);
  std::vector<PairRates> rates(block.size());
  five_terms_single(to_single(block), rates);
  const Deviation near = deviation(rates, exact);
  EXPECT_GT(near.worst, 0);
  EXPECT_LT(near.worst, 2e-6) << near.term;
  // As far off as a track is long: double precision itself then has 3e-14 of a spacing.
  for (std::size_t i = 0; i < block.size(); ++i) {
    block.records[i].x += 1e-3;
  }
  five_terms_single(to_single(block), rates);
  EXPECT_LT(deviation(rates, exact).worst, 2e-6);
  block.records.front().x -= 1;
  EXPECT_THROW(to_single(block), InputError);
}

// A difference that passes over the end of the range comes out as if there were none.
TEST(FixedPoint, DifferencesAreExactAndWrapAround) {
  constexpr double step = 0x1p-22;
  const auto difference = [&](double a, double b) {
    const SingleLane::Simd other(fixed_point(b, step));
    return static_cast<double>(
        fixed_difference(fixed_point(a, step), SingleLane(other), step).value()[0]);
  };
  EXPECT_EQ(difference(400.5, 400.25), 0.25);
  EXPECT_EQ(difference(-300, -301.5), 1.5);
  EXPECT_EQ(difference(511, -511), -2);
}

// What the pairs exchange is antisymmetric, so momentum and heat of the block stay what they are.
TEST(PairLoop, MomentumAndHeatAreExchangedNotMade) {
  const PairBlock block = make_pair_block(14);
  const std::vector<PairRates> rates = scalar_rates(block);
  double force = 0, forces = 0, heat = 0, heats = 0;
  for (std::size_t i = 0; i < block.size(); ++i) {
    force += rates[i].fx;
    forces += std::abs(rates[i].fx);
    heat += rates[i].power * block.records[i].volume;
    heats += std::abs(rates[i].power * block.records[i].volume);
  }
  EXPECT_LT(std::abs(force), 1e-12 * forces);
  EXPECT_LT(std::abs(heat), 1e-12 * heats);
}

// The number that a rate of particles a second stands for.
TEST(PairLoop, TheBlockThatIsTimedHasSome109Neighbours) {
  const PairBlock block = make_pair_block(40);
  EXPECT_NEAR(block.list.mean_neighbours(), 109, 3);
}

TEST(BenchFigure, HasTheMedianAndTheSpreadOfItsRepeats) {
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
  const auto json = figure_json({"key", "1", "how", {3, 1, 2}});
  EXPECT_EQ(json["value"], 2);
  EXPECT_EQ(json["min"], 1);
  EXPECT_EQ(json["max"], 3);
}

// Memory that is touched is resident.
TEST(ResidentMemory, GrowsByWhatIsWritten) {
  const ResidentMemory before = resident_memory();
  ASSERT_GT(before.now, 0);
  const std::vector<char> block(std::size_t{64} << 20, 1);
  EXPECT_GE(resident_memory().now - before.now, 60e6);
  EXPECT_GE(resident_memory().peak, resident_memory().now);
  EXPECT_EQ(block.back(), 1);
}

}  // namespace meltproof::solver

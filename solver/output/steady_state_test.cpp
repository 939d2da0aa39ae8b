// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/steady_state.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "solver/output/saturation_fit.hpp"

namespace meltproof::solver {
namespace {

struct Series {
  std::vector<double> time, value;
};

/// curve(t) every 5 us up to `end`, with noise of standard deviation `noise` that is a first-order
/// autoregression of coefficient `memory`.
Series make(const std::function<double(double)>& curve, double end, double noise, double memory,
            unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  Series s;
  double state = normal(random);
  for (int i = 1; 5e-6 * i <= end * (1 + 1e-12); ++i) {
    s.time.push_back(5e-6 * i);
    s.value.push_back(curve(s.time.back()) + noise * state);
    state = memory * state + std::sqrt(1 - memory * memory) * normal(random);
  }
  return s;
}

double flat(double) { return 100e-6; }
double saturating(double t) { return -400e-6 * std::expm1(-t / 0.45e-3); }

SteadySettings from(double start_up) {
  SteadySettings s;
  s.start_up = start_up;
  return s;
}

/// Share of 200 seeds for which `holds` is true.
double share(const std::function<bool(unsigned)>& holds) {
  int count = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    count += holds(seed) ? 1 : 0;
  }
  return count / 200.0;
}

}  // namespace

TEST(EffectiveSize, AnAutoregressionIsWorthItsShare) {
  for (const double memory : {0.0, 0.5, 0.8}) {
    double sum = 0;
    for (unsigned seed = 0; seed < 50; ++seed) {
      Series s = make(flat, 10e-3, 1e-6, memory, seed);
      double mean = 0;
      for (const double v : s.value) {
        mean += v / static_cast<double>(s.value.size());
      }
      for (double& v : s.value) {
        v -= mean;
      }
      sum += effective_size(s.value, 1).size / 50 / static_cast<double>(s.value.size());
    }
    // The smaller of two estimates: a little low, never high.
    const double exact = (1 - memory) / (1 + memory);
    EXPECT_LT(sum, 1.02 * exact) << memory;
    EXPECT_GT(sum, 0.8 * exact) << memory;
  }
}

TEST(SteadyState, TheIntervalOfTheMeanCoversTheTruth) {
  for (const double memory : {0.0, 0.5, 0.8}) {
    const double covered = share([&](unsigned seed) {
      const Series s = make(flat, 1.04e-3, 5e-6, memory, seed);
      const SteadyState found = judge_steadiness(s.time, s.value, from(0.35e-3));
      return std::abs(found.mean - 100e-6) < found.coverage * found.u_mean;
    });
    // 95 % asked; the binomial scatter of 200 trials is 1.5 %.
    EXPECT_GE(covered, 0.90) << memory;
    EXPECT_LE(covered, 0.995) << memory;
  }
}

TEST(SteadyState, AFlatSeriesIsCalledSteadyAndSeldomGrowing) {
  for (const double memory : {0.0, 0.8}) {
    const auto verdict = [&](unsigned seed) {
      const Series s = make(flat, 1.04e-3, 2e-6, memory, seed);
      return judge_steadiness(s.time, s.value, from(0.35e-3)).verdict;
    };
    EXPECT_GE(share([&](unsigned seed) { return verdict(seed) == "steady"; }), 0.80) << memory;
    EXPECT_LE(share([&](unsigned seed) {
                const auto v = verdict(seed);
                return v == "growing" || v == "shrinking";
              }),
              0.12)
        << memory;
  }
}

TEST(SteadyState, NoiseThatHidesAChangeIsUndecidedNotSteady) {
  EXPECT_LE(share([](unsigned seed) {
              const Series s = make(flat, 0.6e-3, 15e-6, 0.8, seed);
              return judge_steadiness(s.time, s.value, from(0.35e-3)).steady();
            }),
            0.02);
}

TEST(SteadyState, AGrowingSeriesIsNotSteadyAndItsLimitIsCovered) {
  for (const double memory : {0.0, 0.5, 0.8}) {
    int limits = 0, covered = 0, steady = 0;
    for (unsigned seed = 1; seed <= 200; ++seed) {
      const Series s = make(saturating, 1.04e-3, 5e-6, memory, seed);
      const SteadyState found = judge_steadiness(s.time, s.value, from(0.35e-3));
      steady += found.steady() ? 1 : 0;
      limits += found.has_limit ? 1 : 0;
      covered += found.has_limit && std::abs(found.limit - 400e-6) < 2 * found.u_limit ? 1 : 0;
    }
    EXPECT_LE(steady, 2) << memory;
    // Where noise hides the bend, no limit is given.
    EXPECT_GE(limits, memory < 0.7 ? 190 : 160) << memory;
    EXPECT_GE(covered, static_cast<int>(0.90 * limits)) << memory;
    EXPECT_LE(covered, static_cast<int>(0.995 * limits)) << memory;
  }
}

TEST(SteadyState, WithoutNoiseTheLimitIsExact) {
  const Series s = make(saturating, 1.04e-3, 0, 0, 1);
  const SaturationFit fit = fit_saturation(s.time, s.value);
  ASSERT_TRUE(fit.found);
  EXPECT_NEAR(fit.limit, 400e-6, 1e-12);
  EXPECT_NEAR(fit.tau, 0.45e-3, 1e-10);
}

TEST(SteadyState, TheWindowLeavesAnEarlyTransientOut) {
  const Series s =
      make([](double t) { return 100e-6 * (1 - std::exp(-t / 5e-5)); }, 1.04e-3, 1e-6, 0.3, 4);
  const SteadyState found = judge_steadiness(s.time, s.value, from(0));
  EXPECT_TRUE(found.steady()) << found.sentence("width", 1e6, "um");
  EXPECT_GT(found.from, 1e-4);
  EXPECT_NEAR(found.mean, 100e-6, 1e-6);
}

TEST(SteadyState, ASeriesTooShortSaysSo) {
  const Series s = make(saturating, 0.4e-3, 1e-6, 0, 1);
  const SteadyState found = judge_steadiness(s.time, s.value, from(0.35e-3));
  EXPECT_EQ(found.verdict, "too short");
  EXPECT_FALSE(found.has_limit);
  EXPECT_NE(found.sentence("length", 1e6, "um").find("too short to say"), std::string::npos);
  EXPECT_FALSE(found.json("length", 1e6, "um").contains("limit_um"));
  EXPECT_EQ(judge_steadiness({}, {}).verdict, "too short");
}

TEST(SteadyState, ALimitFarBeyondTheSeriesIsNotInvented) {
  // Seen for a fifth of its time constant: the series is a straight line.
  const Series s = make([](double t) { return -400e-6 * std::expm1(-t / 5e-3); }, 1e-3, 1e-6, 0, 2);
  const SteadyState found = judge_steadiness(s.time, s.value, from(0.3e-3));
  EXPECT_EQ(found.verdict, "growing");
  EXPECT_FALSE(found.has_limit);
  EXPECT_NE(found.sentence("length", 1e6, "um").find("cannot be told"), std::string::npos);
}

TEST(SteadyState, ASmoothSeriesIsJudgedAlthoughItsResidualsAreOneCurve) {
  const Series s = make(saturating, 1.04e-3, 0, 0, 1);
  const SteadyState found = judge_steadiness(s.time, s.value, from(0.35e-3));
  EXPECT_EQ(found.verdict, "growing");
  EXPECT_TRUE(found.has_limit);
}

TEST(SteadyState, ShortCorrelatedNoiseIsNotCalledGrowth) {
  EXPECT_LE(share([](unsigned seed) {
              const Series s = make(flat, 0.15e-3, 10e-6, 0.8, seed);
              const auto v = judge_steadiness(s.time, s.value, from(0)).verdict;
              return v == "growing" || v == "shrinking" || v == "steady";
            }),
            0.12);
}

TEST(SteadyState, AChangeThatDoesNotMatterIsSteadyHoweverCertain) {
  const Series s = make([](double t) { return 100e-6 * (1 + 0.002 * t / 1e-3); }, 1e-3, 0, 0, 1);
  EXPECT_TRUE(judge_steadiness(s.time, s.value, from(0.3e-3)).steady());
  const Series still = make(flat, 1e-3, 0, 0, 1);
  EXPECT_TRUE(judge_steadiness(still.time, still.value).steady());
}

}  // namespace meltproof::solver

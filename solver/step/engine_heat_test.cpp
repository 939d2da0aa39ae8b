// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "solver/case/track_case.hpp"
#include "solver/step/engine.hpp"
#include "solver/step/grains.hpp"

namespace meltproof::solver {
namespace {

/// What a track in melt that nothing drives comes to, with heat in several paces or in one.
struct Outcome {
  std::vector<double> temperature, peak;  // K, by identity
  double imbalance = 0;                   // of energy, of what was absorbed
  double cooling_rate = 0;                // K s-1, median of those that froze
  std::uint64_t evaluations = 0;
  std::size_t steps = 0;
  double longest = 0, thermal = 0;  // s: step of those with melt; thermal limit then
};

/// @param grains zero: none; else of so many times the additive's conductivity.
Outcome run(bool multirate, double step_factor = 1, double grains = 0) {
  TrackCase t;
  Input input = declare(t);
  if (grains > 0) {
    input.read("solver/cases/track_1wt.toml",
               {"powder.surface=bare", "laser.power=50 W", "spacing=5 um", "laser.exposure=40 us",
                "domain.width=160 um", "domain.depth=60 um", "domain.before=70 um",
                "domain.behind=70 um", "output.averaging_window=20 us"});
  } else {
    input.read("solver/cases/track_1wt.toml",
               {"powder.surface=bare", "laser.power=50 W", "spacing=10 um", "laser.exposure=100 us",
                "domain.width=280 um", "domain.depth=140 um", "domain.before=112 um",
                "domain.behind=112 um", "output.averaging_window=50 us"});
  }
  Material additive = read_material(t.additive);
  if (grains > 0) {
    for (PropertyPiece& piece : additive.conductivity.pieces) {
      piece.constant *= grains;
      piece.linear *= grains;
    }
  }
  const Mixture mixture(read_material(t.base), additive);
  Discretisation made = discretise(t, mixture);
  if (grains > 0) {
    put_grains(made.particles, mixture);
  }
  Model model = make_model(t, made.domain);
  // Driven, the flow would be chaotic, and the last digit of a temperature would show.
  model.flow->surface_tension = model.flow->marangoni = model.flow->recoil = false;
  model.flow->gravity = {};
  model.flow->shifting = 0;
  model.multirate = multirate;
  model.step_factor = step_factor;
  Engine engine(made.particles, mixture, read_diffusivity(t.diffusivity_laws, t.diffusivity_law),
                model);
  const double before = engine.total_enthalpy(), end = grains > 0 ? 70e-6 : 160e-6;
  Outcome outcome;
  while (engine.time() < end) {
    const bool melt = !engine.flow().liquid().empty();
    const double step = engine.step(end);
    if (melt && step > outcome.longest) {
      outcome.longest = step;
      outcome.thermal = engine.limits().thermal;
    }
  }
  outcome.steps = engine.steps();
  const Particles& p = engine.particles();
  outcome.temperature.resize(p.size());
  outcome.peak.resize(p.size());
  std::vector<double> rates;
  for (std::size_t i = 0; i < p.size(); ++i) {
    outcome.temperature[static_cast<std::size_t>(p.identity[i])] = p.temperature[i];
    outcome.peak[static_cast<std::size_t>(p.identity[i])] = p.peak_temperature[i];
    if (p.freeze_time[i] > 0) {
      rates.push_back(p.cooling_rate[i]);
    }
  }
  EXPECT_GT(rates.size(), 20U);
  std::nth_element(rates.begin(), rates.begin() + static_cast<std::ptrdiff_t>(rates.size() / 2),
                   rates.end());
  outcome.cooling_rate = rates[rates.size() / 2];
  const EnergyLedger& e = engine.ledger();
  outcome.imbalance =
      (engine.total_enthalpy() - before - e.absorbed + e.evaporated + e.radiated + e.convected) /
      e.absorbed;
  outcome.evaluations = engine.heat_evaluations();
  return outcome;
}

/// The largest difference of any temperature, now or at its peak, K.
double largest_difference(const Outcome& a, const Outcome& b) {
  double difference = 0;
  for (std::size_t i = 0; i < a.peak.size(); ++i) {
    difference = std::max({difference, std::abs(a.temperature[i] - b.temperature[i]),
                           std::abs(a.peak[i] - b.peak[i])});
  }
  return difference;
}

/// The root mean square difference of the peaks of what became warm, K.
double typical_difference(const Outcome& a, const Outcome& b) {
  double squares = 0, count = 0;
  for (std::size_t i = 0; i < a.peak.size(); ++i) {
    if (b.peak[i] > 500) {
      squares += (a.peak[i] - b.peak[i]) * (a.peak[i] - b.peak[i]);
      ++count;
    }
  }
  return std::sqrt(squares / count);
}

}  // namespace

// Why a round may be 0.25 h^2/alpha long, see engine_step.cpp. On the lattice, with its moments
// set, sum_j V_j 2 F_ij (T_i - T_j) is alpha's Laplacian: its largest eigenvalue over all waves
// says what is stable, its diagonal up to where no new extreme can arise.
TEST(HeatInTwoPaces, ARoundIsWithinWhatTheLatticeHolds) {
  const QuinticSpline kernel = lattice_kernel(1, 1, 3, LatticeMoments::second);
  std::vector<std::array<double, 4>> pairs;  // place and weight
  double diagonal = 0;
  for (int x = -3; x <= 3; ++x) {
    for (int y = -3; y <= 3; ++y) {
      for (int z = -3; z <= 3; ++z) {
        const double squared = x * x + y * y + z * z;
        if (squared > 0 && squared < kernel.support() * kernel.support()) {
          const double weight = -2 * kernel.gradient_factor(squared);
          pairs.push_back({1.0 * x, 1.0 * y, 1.0 * z, weight});
          diagonal += weight;
        }
      }
    }
  }
  double largest = 0;
  constexpr int waves = 12;
  for (int a = 0; a <= waves; ++a) {
    for (int b = 0; b <= a; ++b) {
      for (int c = 0; c <= b; ++c) {
        double eigenvalue = 0;
        for (const auto& [x, y, z, weight] : pairs) {
          eigenvalue += weight * (1 - std::cos(std::numbers::pi / waves * (a * x + b * y + c * z)));
        }
        largest = std::max(largest, eigenvalue);
      }
    }
  }
  EXPECT_NEAR(largest, 4.0, 0.05);  // Euler is stable up to 2 over this: 0.5 h^2/alpha
  EXPECT_LE(0.25 * diagonal, 1);    // and makes no new extreme while this is below one
}

TEST(HeatInTwoPaces, KeepsEnergyAndTemperaturesForAFractionOfTheWork) {
  const Outcome one = run(false), two = run(true), finer = run(false, 0.5);
  EXPECT_LT(std::abs(two.imbalance), 1e-12);
  EXPECT_LT(static_cast<double>(two.evaluations), 0.5 * static_cast<double>(one.evaluations));
  // What the second pace changes is as small as what half the step changes, some 15 K of 2000.
  const double slow = largest_difference(two, one), half = largest_difference(finer, one);
  EXPECT_LT(slow, 2 * half) << half;
  EXPECT_GT(slow, 1e-6) << "there was no second pace";
  EXPECT_NEAR(two.cooling_rate / one.cooling_rate, 1, 0.03);
}

// Grains of aluminium alloy would hold every step at 0.125 h^2 over their diffusivity, which is
// more than twice that of steel.
TEST(HeatInThreePaces, GrainsThatConductBestDoNotHoldTheStepBack) {
  const Outcome one = run(false, 0.5, 1), three = run(true, 1, 1), finer = run(true, 0.5, 1);
  EXPECT_LT(std::abs(three.imbalance), 1e-12);
  // One pace: half of 0.125 h^2 / (155 W/(m K) / (7763 kg/m3 * 909.09 J/(kg K))).
  EXPECT_LE(one.longest, 0.0712e-6);
  EXPECT_GT(three.longest, 0.22e-6) << "there was no third pace";
  EXPECT_LE(three.longest, three.thermal);
  EXPECT_LT(static_cast<double>(finer.steps), 0.6 * static_cast<double>(one.steps));
  // To the same temperatures, of first order as all of heat is.
  EXPECT_LT(largest_difference(three, one), 30);
  const double whole = typical_difference(three, one), half = typical_difference(finer, one);
  EXPECT_LT(whole, 10);
  EXPECT_NEAR(whole / half, 2, 0.6) << whole << " K, " << half << " K";
  EXPECT_NEAR(three.cooling_rate / one.cooling_rate, 1, 0.03);
}

// In whole steps of 1.3 h^2 over their diffusivity they would be unstable.
TEST(HeatInThreePaces, SubstepsHoldGrainsThatConductFiveTimesAsWell) {
  const Outcome whole = run(true, 1, 5), half = run(true, 0.5, 5);
  EXPECT_GT(whole.longest, 0.2e-6) << "there was no third pace";
  EXPECT_LT(std::abs(whole.imbalance), 1e-12);
  EXPECT_LT(largest_difference(whole, half), 20);
}

}  // namespace meltproof::solver

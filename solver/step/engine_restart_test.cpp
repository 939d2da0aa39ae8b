// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "solver/case/track_case.hpp"
#include "solver/step/engine.hpp"
#include "solver/step/grains.hpp"

namespace meltproof::solver {
namespace {

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TrackCase small_track(std::vector<std::string> more) {
  TrackCase t;
  Input input = declare(t);
  more.insert(more.begin(), {"powder.surface=bare", "laser.exposure=80 us"});
  input.read("solver/cases/track_1wt.toml", more);
  return t;
}

/// Makes an engine of the state of another after every third step, so that states of all kinds are
/// met: just listed, just frozen, beam off, within a round of heat steps. Both must go on alike.
/// @returns the engine that never stopped.
Engine compare_on_the_way(const TrackCase& t, const Discretisation& made, const Mixture& mixture,
                          double end) {
  const Diffusivity law = read_diffusivity(t.diffusivity_laws, t.diffusivity_law);
  const Model model = make_model(t, made.domain);
  Engine whole(made.particles, mixture, law, model);
  std::optional<Engine> resumed;
  for (int k = 0; whole.time() < end && !testing::Test::HasFatalFailure(); ++k) {
    if (k % 3 == 0) {
      resumed.emplace(whole.state(), mixture, law, model);
    }
    whole.step(end);
    resumed->step(end);
    const Particles &a = whole.particles(), &b = resumed->particles();
    [&] {
      ASSERT_EQ(whole.time(), resumed->time()) << k;
      ASSERT_TRUE(same_bytes(a.position, b.position)) << k;
      ASSERT_TRUE(same_bytes(a.velocity, b.velocity)) << k;
      ASSERT_TRUE(same_bytes(a.density, b.density)) << k;
      ASSERT_TRUE(same_bytes(a.enthalpy, b.enthalpy)) << k;
      ASSERT_TRUE(same_bytes(a.concentration, b.concentration)) << k;
      ASSERT_TRUE(same_bytes(a.cooling_rate, b.cooling_rate)) << k;
      for (std::uint32_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(whole.flow().pressure(i), resumed->flow().pressure(i)) << k;
      }
    }();
  }
  return whole;
}

}  // namespace

TEST(EngineState, AnEngineMadeOfTheStateOfAnotherGoesOnAsThatOne) {
  const TrackCase t =
      small_track({"spacing=14 um", "domain.width=224 um", "domain.depth=112 um",
                   "domain.before=84 um", "domain.behind=84 um", "output.averaging_window=50 us"});
  const Mixture mixture(read_material(t.base), read_material(t.additive));
  const Engine whole = compare_on_the_way(t, discretise(t, mixture), mixture, 1.3e-4);
  std::size_t frozen = 0;
  for (const double when : whole.particles().freeze_time) {
    frozen += when > 0 ? 1 : 0;
  }
  EXPECT_GT(frozen, 20U);
  EXPECT_GT(whole.list_builds(), 50U);
}

// Beside grains that take substeps, whose paces are part of the state.
TEST(EngineState, WithHeatInThreePacesToo) {
  const TrackCase t =
      small_track({"spacing=5 um", "domain.width=160 um", "domain.depth=60 um",
                   "domain.before=250 um", "domain.behind=70 um", "output.averaging_window=20 us"});
  const Mixture mixture(read_material(t.base), read_material(t.additive));
  Discretisation made = discretise(t, mixture);
  put_grains(made.particles, mixture);
  const Engine whole = compare_on_the_way(t, made, mixture, 10e-6);
  const std::vector<std::uint8_t> paces = whole.state().pace;
  for (const std::uint8_t pace : {pace::slow, pace::every_step, pace::substeps, pace::asleep}) {
    EXPECT_GT(std::count(paces.begin(), paces.end(), pace), 5) << int{pace};
  }
}

}  // namespace meltproof::solver

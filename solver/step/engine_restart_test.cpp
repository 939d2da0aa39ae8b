// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstring>
#include <optional>

#include <gtest/gtest.h>

#include "solver/case/track_case.hpp"
#include "solver/step/engine.hpp"

namespace meltproof::solver {
namespace {

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TrackCase small_track() {
  TrackCase t;
  Input input = declare(t);
  input.read("solver/cases/track_1wt.toml",
             {"powder.surface=bare", "spacing=14 um", "laser.exposure=80 us", "domain.width=224 um",
              "domain.depth=112 um", "domain.before=84 um", "domain.behind=84 um",
              "output.averaging_window=50 us"});
  return t;
}

}  // namespace

TEST(EngineState, AnEngineMadeOfTheStateOfAnotherGoesOnAsThatOne) {
  const TrackCase t = small_track();
  const Mixture mixture(read_material(t.base), read_material(t.additive));
  const Discretisation made = discretise(t, mixture);
  const Diffusivity law = read_diffusivity(t.diffusivity_laws, t.diffusivity_law);
  const Model model = make_model(t, made.domain);
  Engine whole(made.particles, mixture, law, model);
  std::optional<Engine> resumed;
  std::size_t frozen = 0, builds = 0;
  for (int k = 0; whole.time() < 1.3e-4; ++k) {
    // Every third step, so that states of all kinds are met: just listed, just frozen, beam off.
    if (k % 3 == 0) {
      resumed.emplace(whole.state(), mixture, law, model);
    }
    whole.step(1.3e-4);
    resumed->step(1.3e-4);
    const Particles &a = whole.particles(), &b = resumed->particles();
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
    builds = whole.list_builds();
  }
  for (const double when : whole.particles().freeze_time) {
    frozen += when > 0 ? 1 : 0;
  }
  EXPECT_GT(frozen, 20U);
  EXPECT_GT(builds, 50U);
}

}  // namespace meltproof::solver

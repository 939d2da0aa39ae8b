// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "base/artifact.hpp"
#include "base/error.hpp"
#include "solver/case/track_case.hpp"
#include "solver/output/history.hpp"
#include "solver/output/melt_pool.hpp"

namespace meltproof::solver {
namespace {

Mixture paper_mixture() {
  return {read_material("data/materials/316L.toml"), read_material("data/materials/AlSi10Mg.toml")};
}

std::filesystem::path write_bed(const std::string& name, const std::vector<double>& centre,
                                const std::vector<double>& radius,
                                const std::vector<std::int32_t>& material) {
  const auto path = std::filesystem::temp_directory_path() / name;
  ArtifactWriter writer(path, "meltproof powder bed");
  writer.write("spheres/centre", std::span<const double>(centre), {radius.size(), 3}, "m",
               "synthetic");
  writer.write("spheres/radius", std::span<const double>(radius), {radius.size()}, "m",
               "synthetic");
  writer.write("spheres/material", std::span<const std::int32_t>(material), {radius.size()}, "1",
               "synthetic");
  writer.write("box/lower", std::span<const double>(std::vector<double>{-1e-3, -1e-3, 0}), {3}, "m",
               "synthetic");
  writer.write("box/upper", std::span<const double>(std::vector<double>{1e-3, 1e-3, 2e-5}), {3},
               "m", "synthetic");
  writer.write("additive_mass_fraction", 0.05, "1", "synthetic");
  writer.commit({});
  return path;
}

TrackCase small_case() {
  TrackCase t;
  t.spacing = 2e-6;
  t.before = t.behind = 20e-6;
  t.exposure = 1e-4;
  t.width = 60e-6;
  t.depth = 10e-6;
  return t;
}

}  // namespace

TEST(Discretise, GrainsKeepTheirVolumeAndTheirAdditive) {
  TrackCase t = small_case();
  const double r = 7e-6;
  t.bed = write_bed("meltproof_grains.h5", {0, 0, r, 20e-6, 3e-6, r}, {r, r}, {0, 1});
  const Discretisation made = discretise(t, paper_mixture());
  const double exact = 2 * 4.0 / 3 * M_PI * r * r * r;
  EXPECT_NEAR(made.powder_volume / exact, 1, 5e-3);
  EXPECT_LT(std::abs(made.powder_volume_error), std::pow(t.spacing, 3) / exact + 1e-12);
  EXPECT_NEAR(made.additive_mass_fraction, 0.5, std::pow(t.spacing, 3) / exact);
  EXPECT_EQ(made.bed_additive_mass_fraction, 0.05);
  double top = 0;
  for (const auto& at : made.particles.position) {
    top = std::max(top, at[2]);
  }
  EXPECT_GT(top, 2 * r - 2 * t.spacing);
  EXPECT_LT(top, 2 * r);
}

TEST(Discretise, ABarePlateNeedsNoBedAndAPowderCaseDoes) {
  TrackCase t = small_case();
  EXPECT_THROW(discretise(t, paper_mixture()), InputError);
  t.surface = "bare";
  const auto made = discretise(t, paper_mixture());
  for (const auto origin : made.particles.origin) {
    ASSERT_EQ(origin, Origin::plate);
  }
}

TEST(TrackCase, ASpacingThatCannotHoldTheBeamIsRefused) {
  TrackCase t = small_case();
  t.spacing = 25e-6;
  EXPECT_THROW(warnings(t, paper_mixture()), InputError);
  t.spacing = 14e-6;
  EXPECT_FALSE(warnings(t, paper_mixture()).empty());
}

TEST(TrackCase, ADensityThatGoesToItsSumFasterThanSoundIsRefused) {
  TrackCase t = small_case();
  t.spacing = 14e-6;
  t.flow.settings.density_relaxation = 1;
  warnings(t, paper_mixture());
  t.flow.settings.density_relaxation = 0;  // never
  warnings(t, paper_mixture());
  t.flow.settings.density_relaxation = 0.99;
  EXPECT_THROW(warnings(t, paper_mixture()), InputError);
}

TEST(TrackCase, SensitivitiesChangeOneInputAndNothingElse) {
  TrackCase t;
  t.base = "data/materials/316L.toml";
  t.additive = "data/materials/AlSi10Mg.toml";
  const Mixture file = read_mixture(t);
  t.conductivity_factor = 1.05;
  t.tension_slope_factor = 1.2;
  t.additive_molar_mass = 0.33214;
  const Mixture changed = read_mixture(t);
  for (const double temperature : {300.0, 1660.0, 2000.0, 2800.0}) {
    EXPECT_NEAR(changed.conductivity(temperature, 0), 1.05 * file.conductivity(temperature, 0),
                1e-12);
    EXPECT_EQ(changed.conductivity(temperature, 1), file.conductivity(temperature, 1));
    EXPECT_EQ(changed.viscosity(temperature, 0), file.viscosity(temperature, 0));
  }
  // Constant below 2166 K, then -1.1e-4 N/(m K): the slope changes, the value of cool melt does
  // not.
  EXPECT_NEAR(changed.surface_tension(1700, 0), 1.82, 1e-12);
  EXPECT_NEAR(changed.surface_tension(2166, 0), 1.82, 1e-5);
  EXPECT_NEAR(changed.surface_tension(2800, 0) - changed.surface_tension(2400, 0), -1.32e-4 * 400,
              1e-12);
  EXPECT_EQ(changed.surface_tension(2800, 1), file.surface_tension(2800, 1));
  EXPECT_EQ(changed.molar_mass(1), 0.33214);
  EXPECT_EQ(changed.molar_mass(0), file.molar_mass(0));
}

TEST(MeltPool, ASphericalPoolIsMeasuredFinerThanTheSpacing) {
  const double dx = 10e-6, radius = 57.3e-6;
  Particles particles;
  particles.spacing = dx;
  std::vector<double> level;
  for (int k = -12; k < 0; ++k) {
    for (int j = -12; j < 12; ++j) {
      for (int i = -12; i < 12; ++i) {
        const Vector at{(i + 0.5) * dx, (j + 0.5) * dx, (k + 0.5) * dx};
        particles.add(static_cast<std::int64_t>(particles.size()), at, 1, dx * dx * dx, 0, 0,
                      Origin::plate);
        level.push_back(radius - std::sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]));
      }
    }
  }
  // A second spot apart from the pool, hotter than all of it, must not count when connected is
  // asked: spray that absorbs the beam may be the hottest there is.
  level[0] = 1;
  const auto list = pack_neighbours(particles, {}, 3 * dx);
  const Extent pool = measure_extent(particles, list, level, true);
  // Lattice points nearest to the axes sit half a spacing off them, which shortens chords by 0.25
  // um.
  EXPECT_NEAR(pool.length, 2 * radius, 0.05 * dx * 2);
  EXPECT_NEAR(pool.width, 2 * radius, 0.05 * dx * 2);
  EXPECT_NEAR(pool.depth, radius, 0.05 * dx * 2);
  double inside = 0;
  for (std::size_t i = 1; i < level.size(); ++i) {
    inside += level[i] >= 0 ? dx * dx * dx : 0;
  }
  EXPECT_NEAR(pool.volume / inside, 1, 1e-12);
  EXPECT_GT(measure_extent(particles, list, level, false).length, 170e-6);
}

TEST(History, WindowsGiveMeanScatterAndGrowth) {
  std::vector<HistoryLine> lines(11);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    lines[i].time = 1e-5 * static_cast<double>(i);
    lines[i].peak_temperature = 100 + 2 * static_cast<double>(i);
  }
  const auto w =
      window_mean(lines, 5e-5, 1e-4, [](const HistoryLine& l) { return l.peak_temperature; });
  EXPECT_EQ(w.count, 6U);
  EXPECT_DOUBLE_EQ(w.mean, 115);
  EXPECT_NEAR(w.growth, 2e5, 1e-3);
  EXPECT_NEAR(w.deviation, std::sqrt(14.0), 1e-12);
}

}  // namespace meltproof::solver

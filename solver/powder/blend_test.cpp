// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/powder/blend.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/powder/powder_bed.hpp"

namespace meltproof::solver {
namespace {

TEST(SizeDistribution, HasTheMomentsOfALogNormal) {
  SizeSettings settings;
  settings.geometric_deviation = 1.4;
  settings.truncation = 5;
  settings.by_volume = false;
  const SizeDistribution sizes(settings, "base");
  const double s = std::log(1.4);
  EXPECT_NEAR(sizes.moment(1), 13.7e-6 * std::exp(s * s / 2), 1e-4 * 13.7e-6);
  Random random(3);
  double sum = 0, logs = 0, squares = 0;
  const int n = 200000;
  for (int i = 0; i < n; ++i) {
    const double d = sizes.draw(random);
    sum += d;
    logs += std::log(d / 13.7e-6);
    squares += std::pow(std::log(d / 13.7e-6), 2);
  }
  const double four_errors = 4 / std::sqrt(n);
  EXPECT_NEAR(sum / n, sizes.moment(1), four_errors * s * sizes.moment(1));
  EXPECT_NEAR(logs / n, 0, four_errors * s);
  EXPECT_NEAR(squares / n, s * s, four_errors * std::numbers::sqrt2 * s * s);
}

TEST(SizeDistribution, TurnsVolumeIntoNumberByHatchAndChoate) {
  SizeSettings settings;
  settings.d10 = 9e-6;
  settings.d50 = 14e-6;
  settings.d90 = 22e-6;
  settings.truncation = 3;
  const SizeDistribution sizes(settings, "base");
  const double s = std::log(22. / 9) / (2 * 1.2815515655446004);
  EXPECT_NEAR(sizes.median(), 14e-6 * std::exp(-3 * s * s), 1e-18);
  EXPECT_NEAR(sizes.volume_quantile(0.5), 14e-6, 1e-10);
  // The cut draws the outer percentiles in by a little.
  EXPECT_NEAR(sizes.volume_quantile(0.1), 14e-6 * std::exp(-1.28155 * s), 0.01 * 9e-6);
  Random random(5);
  double below = 0, all = 0;
  for (int i = 0; i < 200000; ++i) {
    const double d = sizes.draw(random), volume = d * d * d;
    all += volume;
    below += d < 14e-6 ? volume : 0;
  }
  EXPECT_NEAR(below / all, 0.5, 0.01);
}

TEST(Blend, HasTheMassFractionAskedForWithinOneSphere) {
  for (const double asked : {0.01, 0.05, 0.5}) {
    for (const double density : {7763., 2670.}) {
      PowderSettings s;
      s.length_x = 300e-6;
      s.additive_mass_fraction = asked;
      s.additive.density = density;
      s.additive.size.d50 = 11.3e-6;
      s.base.size.d50 = 15.4e-6;
      const PowderBed bed = generate(s);
      double total = 0;
      for (std::size_t i = 0; i < bed.spheres.size(); ++i) {
        total += (bed.material[i] == 1 ? density : 7763) * std::pow(bed.spheres[i].radius, 3);
      }
      const double largest =
          std::pow(SizeDistribution(s.additive.size, "additive").largest() / 2, 3) * 7763;
      EXPECT_NEAR(bed.additive_mass_fraction, asked, largest / total);
      EXPECT_GT(bed.additive_mass_fraction, 0);
    }
  }
}

TEST(Blend, KeepsTheSizesOfBothPowders) {
  PowderSettings s;
  s.base.size.d50 = 15.4e-6;
  s.additive.size.d50 = 11.3e-6;
  const Blend blend{{s.base.size, "base"}, {s.additive.size, "additive"}, 7763, 2670, 0.3};
  Random random(7);
  std::vector<Sphere> spheres(40000);
  for (Sphere& sphere : spheres) {
    sphere.radius = blend.draw(random) / 2;
  }
  const auto material = assign_materials(spheres, blend, random);
  EXPECT_NEAR(additive_mass_fraction(spheres, material, blend), 0.3, 1e-4);
  double sum[2] = {0, 0}, count[2] = {0, 0};
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    sum[material[i]] += 2 * spheres[i].radius;
    ++count[material[i]];
  }
  EXPECT_NEAR(count[1] / 40000, blend.additive_number_fraction(), 0.01);
  EXPECT_NEAR(sum[0] / count[0] / blend.base.moment(1), 1, 0.01);
  EXPECT_NEAR(sum[1] / count[1] / blend.additive.moment(1), 1, 0.01);
}

}  // namespace
}  // namespace meltproof::solver

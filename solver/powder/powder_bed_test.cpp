// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/powder/powder_bed.hpp"

#include <cmath>
#include <ctime>
#include <numbers>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "base/artifact.hpp"
#include "base/error.hpp"

namespace meltproof::solver {
namespace {

using Eigen::Vector3d;

/// The vector from b to the image of a that is nearest to it.
Vector3d between(const Vector3d& a, const Vector3d& b, const PowderSettings& s) {
  Vector3d d = a - b;
  if (s.periodic) {
    d.x() -= s.length_x * std::round(d.x() / s.length_x);
    d.y() -= s.length_y * std::round(d.y() / s.length_y);
  }
  return d;
}

/// Deepest overlap of any pair, or of a sphere with floor or walls, over the smaller radius: by all
/// pairs, independent of the grid that made the bed.
double deepest_overlap(const PowderBed& bed, const PowderSettings& s) {
  double deepest = -1;
  const auto& spheres = bed.spheres;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double r = spheres[i].radius;
    const Vector3d low = spheres[i].centre - bed.lower, high = bed.upper - spheres[i].centre;
    deepest = std::max(deepest, (r - low.z()) / r);
    if (!s.periodic) {
      deepest = std::max(deepest, (r - std::min({low.x(), low.y(), high.x(), high.y()})) / r);
    }
    for (std::size_t j = 0; j < i; ++j) {
      const double distance = between(spheres[i].centre, spheres[j].centre, s).norm();
      const double q = spheres[j].radius;
      deepest = std::max(deepest, (r + q - distance) / std::min(r, q));
    }
  }
  return deepest;
}

/// Every sphere lies on the floor, or the upward force can be made of pushes at its supports.
void expect_stable(const PowderBed& bed, const PowderSettings& s) {
  for (std::size_t i = 0; i < bed.spheres.size(); ++i) {
    const Sphere& sphere = bed.spheres[i];
    std::vector<Vector3d> directions;
    int walls = 0;
    bool floor = false;
    for (const int support : bed.supports[i]) {
      floor = floor || support == floor_support;
      walls += support == wall_support ? 1 : 0;
      if (support >= 0) {
        const Vector3d d = between(sphere.centre, bed.spheres[support].centre, s);
        ASSERT_NEAR(d.norm(), sphere.radius + bed.spheres[support].radius, 1e-9 * sphere.radius);
        directions.push_back(d.normalized());
      }
    }
    if (floor) {
      EXPECT_NEAR(sphere.centre.z(), sphere.radius, 1e-9 * sphere.radius);
      continue;
    }
    ASSERT_EQ(directions.size() + walls, 3U) << "sphere " << i;
    if (walls == 0) {
      Eigen::Matrix3d e;
      e << directions[0], directions[1], directions[2];
      // Cramer's rule, so that the test shares no code with what it tests.
      const double all = e.determinant();
      for (int k = 0; k < 3; ++k) {
        Eigen::Matrix3d replaced = e;
        replaced.col(k) = Vector3d::UnitZ();
        EXPECT_GE(replaced.determinant() / all, -1e-9) << "sphere " << i << " tips over";
      }
    }
  }
}

PowderSettings deep_bed_of_one_size(double diameters_wide, double diameters_high) {
  PowderSettings s;
  s.base.size.d50 = 10e-6;
  s.base.size.geometric_deviation = 1;
  s.periodic = true;
  s.length_x = s.length_y = diameters_wide * 10e-6;
  s.layer_height = diameters_high * 10e-6;
  return s;
}

TEST(DropAndRoll, PacksEqualSpheresAsPublished) {
  // Published for drop and roll along the steepest descent: density 0.582 (Visscher and Bolsterli
  // 1972), 0.58 (Jodrey and Tory 1979); each sphere has three supports, so the mean coordination
  // is 6.
  const PowderSettings s = deep_bed_of_one_size(16, 30);
  const PowderBed bed = generate(s);
  double volume = 0, contacts = 0, inside = 0;
  const double low = 6 * 10e-6,
               high = 24 * 10e-6;  // away from the floor's layers and the cut surface
  for (std::size_t i = 0; i < bed.spheres.size(); ++i) {
    volume += sphere_volume_between(bed.spheres[i], low, high);
    const double z = bed.spheres[i].centre.z();
    if (z > low && z < high) {
      contacts += bed.coordination[i];
      ++inside;
    }
  }
  const double density = volume / (s.length_x * s.length_y * (high - low));
  EXPECT_GT(inside, 4000);
  EXPECT_NEAR(density, 0.582, 0.008);
  EXPECT_NEAR(contacts / inside, 6, 0.1);
  RecordProperty("packing_density", std::to_string(density));
  std::cout << "deep bed of one size: density " << density << ", coordination " << contacts / inside
            << ", " << bed.dropped_again << " of " << bed.dropped << " dropped again\n";
}

TEST(DropAndRoll, LeavesNoOverlapsAndEverySphereStable) {
  for (const bool periodic : {true, false}) {
    PowderSettings s;
    s.periodic = periodic;
    s.layer_height = 60e-6;
    s.length_x = 300e-6;
    s.base.size.geometric_deviation = 1.5;
    s.origin_x = -100e-6;
    const PowderBed bed = generate(s);
    ASSERT_GT(bed.spheres.size(), 2000U);
    EXPECT_LT(deepest_overlap(bed, s), 1e-9);
    expect_stable(bed, s);
    EXPECT_EQ(bed.dropped_again, 0);
  }
}

TEST(PowderBed, IsTheSameForTheSameSeedOnly) {
  PowderSettings s;
  s.length_x = 200e-6;
  const PowderBed first = generate(s), second = generate(s);
  s.seed = 2;
  const PowderBed other = generate(s);
  ASSERT_EQ(first.spheres.size(), second.spheres.size());
  for (std::size_t i = 0; i < first.spheres.size(); ++i) {
    EXPECT_EQ(first.spheres[i].centre, second.spheres[i].centre);
    EXPECT_EQ(first.spheres[i].radius, second.spheres[i].radius);
  }
  EXPECT_NE(first.spheres[0].centre, other.spheres[0].centre);
}

TEST(PowderBed, LeavesNothingAboveTheLayerThatTheBladeTakes) {
  for (const char* blade : {"centre", "top"}) {
    PowderSettings s;
    s.length_x = 300e-6;
    s.blade = blade;
    const PowderBed bed = generate(s);
    for (const Sphere& sphere : bed.spheres) {
      const double height = sphere.centre.z() + (s.blade == "top" ? sphere.radius : 0);
      EXPECT_LE(height, s.layer_height);
    }
    expect_stable(bed, s);
  }
}

TEST(PowderBed, MeasuresTheVolumeOfASphereBetweenTwoHeights) {
  const Sphere sphere{{0, 0, 1}, 1};
  const double whole = 4. / 3 * std::numbers::pi;
  EXPECT_NEAR(sphere_volume_between(sphere, -5, 5), whole, 1e-12);
  EXPECT_NEAR(sphere_volume_between(sphere, 0, 1), whole / 2, 1e-12);
  EXPECT_NEAR(sphere_volume_between(sphere, 1.5, 9), std::numbers::pi * 0.25 * (3 - 0.5) / 3,
              1e-12);
  EXPECT_EQ(sphere_volume_between(sphere, 3, 4), 0);
}

TEST(PowderBed, RefusesWhatCannotBeWithASentence) {
  const auto refusal = [](const std::function<void(PowderSettings&)>& spoil) -> std::string {
    PowderSettings s;
    spoil(s);
    try {
      check(s);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal([](auto& s) {
              s.base.size.d10 = 20e-6, s.base.size.d90 = 15e-6;
            }).find("d10 < d50 < d90"),
            std::string::npos);
  EXPECT_NE(refusal([](auto& s) { s.base.size.d90 = 20e-6; }).find("give both"), std::string::npos);
  EXPECT_NE(refusal([](auto& s) { s.length_y = 10e-6; }).find("box.length_y"), std::string::npos);
  EXPECT_NE(refusal([](auto& s) { s.periodic = true, s.length_x = 40e-6; }).find("twice"),
            std::string::npos);
  EXPECT_NE(refusal([](auto& s) { s.layer_height = 5e-6; }).find("box.layer_height"),
            std::string::npos);
  EXPECT_EQ(refusal([](auto&) {}), "");
}

TEST(PowderBed, ReadsItsInputWithThePapersDefaults) {
  PowderSettings s;
  Input input(powder_table(s));
  input.read_text("additive_mass_fraction = \"5 %\"\n[box]\nlength_x = \"300 um\"\n", "bed.toml");
  EXPECT_EQ(s.additive_mass_fraction, 0.05);
  EXPECT_NEAR(s.length_x, 300e-6, 1e-18);
  EXPECT_EQ(s.base.size.d50, 13.7e-6);
  EXPECT_EQ(s.layer_height, 20e-6);
  EXPECT_THROW(input.read_text("[box]\nlenght_x = \"1 mm\"\n", "bed.toml"), InputError);
}

TEST(PowderBed, IsWrittenAsAnArtifactWithUnits) {
  PowderSettings s;
  s.length_x = 200e-6;
  const PowderBed bed = generate(s);
  const auto path = std::filesystem::temp_directory_path() / "meltproof_powder_test.h5";
  write_powder_bed(path, bed, Provenance{});
  {
    const ArtifactReader file(path, "meltproof powder bed");
    const auto centre = file.read<double>("spheres/centre");
    EXPECT_EQ(centre.shape, (std::vector<std::size_t>{bed.spheres.size(), 3}));
    EXPECT_EQ(centre.units, "m");
    EXPECT_EQ(centre.values[5], bed.spheres[1].centre.z());
    EXPECT_EQ(file.scalar("packing_density"), bed.packing_density);
    EXPECT_EQ(file.read<double>("box/upper").values[2], s.layer_height);
  }
  std::filesystem::remove(path);
}

TEST(PowderBed, OfTenThousandSpheresTakesSeconds) {
  PowderSettings s;
  s.length_x = 1500e-6;
  s.length_y = 800e-6;
  s.layer_height = 25e-6;
  const std::clock_t start = std::clock();
  const PowderBed bed = generate(s);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  EXPECT_GT(bed.spheres.size(), 10000U);
#ifdef NDEBUG
  EXPECT_LT(seconds, 10);  // of processor time; 1.4 s measured
#endif
  std::cout << bed.spheres.size() << " spheres in " << seconds << " s\n";
}

}  // namespace
}  // namespace meltproof::solver

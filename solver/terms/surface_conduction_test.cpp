// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/terms/surface_conduction.hpp"

#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace meltproof::solver {
namespace {

constexpr double dx = 10e-6, conductivity = 25;

/// A plate of 14 x 14 x 12 particles whose surface is at z = 0, with everything that a pass over
/// heat needs.
struct Plate {
  Particles particles;
  QuinticSpline kernel{dx, 3};
  PackedLists neighbours;
  std::vector<HeatRecord> records;
  SurfaceConduction surface;

  template <class Temperature>
  explicit Plate(const Temperature& temperature, double disorder = 0) {
    set_lattice_moments(kernel, dx, 3, LatticeMoments::second);
    particles.spacing = dx;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> shift(-disorder * dx, disorder * dx);
    for (int k = 0; k < 12; ++k) {
      for (int j = 0; j < 14; ++j) {
        for (int i = 0; i < 14; ++i) {
          particles.add(static_cast<std::int64_t>(particles.size()),
                        {(i + 0.5) * dx + shift(random), (j + 0.5) * dx + shift(random),
                         -(k + 0.5) * dx + shift(random)},
                        1e-12, dx * dx * dx, 0, 0, Origin::plate);
        }
      }
    }
    neighbours = pack_neighbours(particles, {}, kernel.support());
    records.resize(particles.size() + 1);
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const Vector& at = particles.position[i];
      HeatRecord& record = records[i];
      record.x = at[0];
      record.y = at[1];
      record.z = at[2];
      record.volume = particles.volume[i];
      record.temperature = temperature(at);
      record.conductivity = conductivity;
      record.awake = 1;
    }
    surface.update(records, {}, neighbours, kernel);
  }

  std::vector<double> power(bool corrected) const {
    std::vector<double> result(particles.size(), 0.0);
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const HeatRecord& a = records[i];
      neighbours.each(i, [&](std::uint32_t j) {
        const HeatRecord& b = records[j];
        const double x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
        result[i] += conduction_pair(a.conductivity, a.temperature, b.conductivity, b.temperature,
                                     b.volume, kernel.gradient_factor(x * x + y * y + z * z));
      });
    }
    if (corrected) {
      std::vector<std::uint32_t> active(result.size());
      std::iota(active.begin(), active.end(), 0U);
      surface.add(records, neighbours, kernel, active, result);
    }
    return result;
  }

  /// The particle of the layer `k` below the surface in the middle of the plate.
  std::size_t middle(int k) const { return static_cast<std::size_t>((k * 14 + 7) * 14 + 7); }
};

double bowl(const Vector& at) { return 1e10 * (at[0] * at[0] + at[1] * at[1]); }

}  // namespace

TEST(SurfaceConduction, AlongAPlaneSurfaceTheLaplacianIsThatOfTheInterior) {
  const Plate plate(bowl);
  const double exact = 4e10 * conductivity;
  const auto plain = plate.power(false), corrected = plate.power(true);
  EXPECT_NEAR(plain[plate.middle(6)], exact, 1e-6 * exact);
  EXPECT_LT(plain[plate.middle(0)], 0.80 * exact) << "or there would be nothing to correct";
  EXPECT_NEAR(corrected[plate.middle(0)], exact, 5e-3 * exact);
  EXPECT_NEAR(corrected[plate.middle(1)], exact, 5e-3 * exact);
}

TEST(SurfaceConduction, LeavesTheInteriorAlone) {
  const Plate plate(bowl);
  EXPECT_EQ(plate.power(true)[plate.middle(6)], plate.power(false)[plate.middle(6)]);
  EXPECT_EQ(plate.surface.surface()[plate.middle(6)].gain, 0);
  EXPECT_NEAR(plate.surface.surface()[plate.middle(0)].nz, 1, 1e-12);
}

TEST(SurfaceConduction, LosesNothingOnADisorderedPlate) {
  const Plate plate([](const Vector& at) { return 300 + 1e6 * std::abs(std::sin(1e5 * at[0])); },
                    0.2);
  double sum = 0, size = 0, added = 0;
  const auto plain = plate.power(false), corrected = plate.power(true);
  for (std::size_t i = 0; i < plain.size(); ++i) {
    sum += plate.records[i].volume * corrected[i];
    size += plate.records[i].volume * std::abs(corrected[i]);
    added += std::abs(corrected[i] - plain[i]);
  }
  EXPECT_LT(std::abs(sum), 1e-12 * size);
  EXPECT_GT(added, 0);
}

TEST(SurfaceConduction, LookingAtAPartOfThePlateAgainChangesNothing) {
  Plate plate(bowl);
  const auto before = plate.power(true);
  std::vector<std::uint32_t> corner;
  for (std::uint32_t i = 0; i < plate.particles.size(); i += 3) {
    corner.push_back(i);
  }
  std::vector<double> gains;
  for (const auto& record : plate.surface.surface()) {
    gains.push_back(record.gain);
  }
  plate.surface.update(plate.records, {}, plate.neighbours, plate.kernel, &corner);
  for (std::size_t i = 0; i < gains.size(); ++i) {
    // The sweeps begin anew for a part, so they end a little elsewhere.
    EXPECT_NEAR(plate.surface.surface()[i].gain, gains[i], 0.02);
  }
  const auto after = plate.power(true);
  EXPECT_NEAR(after[plate.middle(0)], before[plate.middle(0)], 5e-3 * before[plate.middle(0)]);
}

TEST(SurfaceConduction, NoGainLeavesItsBounds) {
  const Plate plate(bowl, 0.3);
  for (const auto& record : plate.surface.surface()) {
    EXPECT_GE(record.gain, SurfaceConduction::smallest_gain);
    EXPECT_LE(record.gain, SurfaceConduction::largest_gain);
  }
}

}  // namespace meltproof::solver

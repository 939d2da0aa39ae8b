// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "base/error.hpp"
#include "imaging/camera/rosenthal.hpp"
#include "imaging/camera/scene.hpp"
#include "imaging/camera/section.hpp"

namespace meltproof::imaging {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

TEST(Noise, IsStandardNormalAndItsFirstNumbersAreFixed) {
  Noise noise(1);
  double sum = 0, squares = 0, fourth = 0;
  constexpr int n = 400000;
  for (int i = 0; i < n; ++i) {
    const double x = noise.normal();
    sum += x, squares += x * x, fourth += x * x * x * x;
  }
  EXPECT_NEAR(sum / n, 0, 0.006);
  EXPECT_NEAR(squares / n, 1, 0.01);
  EXPECT_NEAR(fourth / n, 3, 0.06);
  // The engine's ten-thousandth number for the default seed is in the C++ standard; uniform() is
  // its top 53 bits.
  Noise fixed(5489);
  double u = 0;
  for (int i = 0; i < 10000; ++i) u = fixed.uniform();
  EXPECT_EQ(u, (static_cast<double>(9981545732273789042ULL >> 11) + 0.5) * 0x1p-53);
}

TEST(Rosenthal, PoolOfTheDesignIs261Point80By131Point74) {
  const RosenthalPool pool = rosenthal_pool({});
  EXPECT_NEAR(pool.length * 1e6, 261.80, 0.005);
  EXPECT_NEAR(pool.width * 1e6, 131.74, 0.005);
  EXPECT_NEAR(rosenthal_temperature({}, -0.5 * pool.length, 0, 0) > 1673.15, true, 0);
}

TEST(Camera, UniformMetalIsTheSignalEquation) {
  CameraSettings settings;
  const Camera camera(settings);
  const SceneGrid grid(settings, 0, 7.5e-6);
  for (const double t : {900.0, 1673.15, 3000.0}) {
    const cv::Mat image = camera.expose(render_scene(
                                            [&](double, double) {
                                              return RayHit{t, 0.3};
                                            },
                                            grid),
                                        grid, 7.5e-6);
    EXPECT_EQ(image.size(), cv::Size(96, 40));
    double low = 0, high = 0;
    cv::minMaxLoc(image, &low, &high);
    EXPECT_NEAR(low / signal(camera.radiometry(), t), 1, 1e-8);
    EXPECT_NEAR(high / signal(camera.radiometry(), t), 1, 1e-8);
  }
  // The stated temperature of liquid metal fills the counts.
  EXPECT_NEAR(signal(camera.radiometry(), 3500, 0.2), 16383, 1e-6);
}

TEST(Camera, RaysWithoutMetalSeeTheSurroundings) {
  CameraSettings settings;
  const Camera camera(settings);
  const SceneGrid grid(settings, 0, 0);
  const cv::Mat image = camera.expose(render_scene(
                                          [](double, double) {
                                            return RayHit{none, 1};
                                          },
                                          grid),
                                      grid, 0);
  EXPECT_NEAR(image.at<double>(20, 50) / signal(camera.radiometry(), 293.15, 1), 1, 1e-8);
}

// The image of a straight border is the error function of the point spread, and motion adds a box
// whose variance is (v t)^2 / 12.
TEST(Camera, PointSpreadAndMotionBlurABorderAsTheyShould) {
  CameraSettings settings;
  settings.ambient_temperature = 0;
  settings.emissivity_solid = 1;
  const double px = settings.pixel_size;
  for (const double motion : {0.0, 60e-6}) {
    const Camera camera(settings);
    const SceneGrid grid(settings, 0, motion);
    const Scene scene = render_scene(
        [](double u, double) {
          return RayHit{u > 0 ? 1500 : none, 1};
        },
        grid);
    const cv::Mat image = camera.expose(scene, grid, motion);
    const double full = signal(camera.radiometry(), 1500) - settings.dark;
    // Moments of the derivative: differences of neighbouring pixels sit on the pixels' borders. The
    // pixel averages over one pixel and the difference sums over one, each with variance 1/12.
    double total = 0, mean = 0, square = 0;
    for (int column = 0; column + 1 < 96; ++column) {
      const double step = (image.at<double>(20, column + 1) - image.at<double>(20, column)) / full;
      const double at = column + 1 - 48;
      total += step, mean += step * at, square += step * at * at;
    }
    EXPECT_NEAR(total, 1, 1e-6);
    EXPECT_NEAR(mean, 0, 1e-6);
    EXPECT_NEAR(square, 0.8 * 0.8 + 1.0 / 6 + motion * motion / (12 * px * px), 0.01);
  }
}

TEST(Camera, PixelsLieWhereTheGridSays) {
  CameraSettings settings;
  settings.point_spread = 0;
  settings.ambient_temperature = 0;
  for (const char* look : {"+y", "-y"}) {
    settings.look = look;
    const Camera camera(settings);
    const SceneGrid grid(settings, 1e-3, 0);
    const double u0 = 1e-3 + 10.5 * settings.pixel_size, v0 = 2 * settings.pixel_size;
    const Scene scene = render_scene(
        [&](double u, double v) {
          const bool inside = std::abs(u - u0) < 0.5 * settings.pixel_size &&
                              std::abs(v - v0) < 0.5 * settings.pixel_size;
          return RayHit{inside ? 2000 : none, 1};
        },
        grid);
    cv::Point brightest;
    cv::minMaxLoc(camera.expose(scene, grid, 0), nullptr, nullptr, nullptr, &brightest);
    // Columns 47 and 48 meet at the centre; z = 0 lies in row 12.
    EXPECT_EQ(brightest, cv::Point(settings.direction() > 0 ? 58 : 37, 10));
    EXPECT_NEAR(grid.pixel_column(u0), brightest.x, 1e-9);
    EXPECT_NEAR(grid.first_pixel_v(), 12 * settings.pixel_size, 1e-12);
  }
}

TEST(Camera, ShotNoiseHasTheVarianceOfItsElectrons) {
  CameraSettings settings;
  settings.full_well = 1e5;  // few electrons, so that shot noise dominates
  settings.read_noise = 0;
  const Camera camera(settings);
  Noise noise(3);
  const cv::Mat level(200, 200, CV_64F, cv::Scalar(8000));
  const auto counts = camera.detect(level, noise);
  double mean = 0, square = 0;
  for (const auto c : counts) mean += c / 4e4, square += std::pow(c - 8000.0, 2) / 4e4;
  const double gain = (16383 - settings.dark) / settings.full_well;
  EXPECT_NEAR(mean, 8000, 1);
  EXPECT_NEAR(square / ((8000 - settings.dark) * gain), 1, 0.03);
}

TEST(Camera, CountsAreWholeAndEndAtFullScale) {
  CameraSettings settings;
  settings.read_noise = 0;
  settings.full_well = 1e30;
  const Camera camera(settings);
  Noise noise(1);
  const cv::Mat signal = (cv::Mat_<double>(1, 4) << -5, 200.4, 16382.6, 20000);
  EXPECT_EQ(camera.detect(signal, noise), (std::vector<std::uint16_t>{0, 200, 16383, 16383}));
}

/// A block of metal below z = 0 at spacing dx, T falling linearly with depth, optionally displaced.
ParticleSnapshot block(double dx, double disorder, double lower_y) {
  ParticleSnapshot s;
  s.spacing = dx;
  Noise noise(11);
  const auto jitter = [&] { return disorder * dx * (2 * noise.uniform() - 1); };
  for (double x = -300e-6 + dx / 2; x < 300e-6; x += dx)
    for (double y = lower_y + dx / 2; y < 60e-6; y += dx)
      for (double z = -150e-6 + dx / 2; z < 0; z += dx) {
        const double px = x + jitter(), py = y + jitter(), pz = z + jitter();
        s.position.insert(s.position.end(), {px, py, pz});
        s.temperature.push_back(1500 + 2e6 * pz + 1e6 * px);
        s.liquid_fraction.push_back(px > 0 ? 1 : 0);
      }
  return s;
}

TEST(Section, ShowsTheFieldOfALatticeAndOfDisorderedParticles) {
  CameraSettings settings;
  const SceneGrid grid(settings, 0, 0);
  for (const double disorder : {0.0, 0.2}) {
    const Scene scene = render_section(block(10e-6, disorder, -60e-6), settings, grid);
    for (const double u : {-200e-6, -33e-6, 150e-6})
      for (const double v : {-20e-6, -61e-6, -120e-6}) {
        const int column = static_cast<int>(std::lround(grid.column(u))),
                  row = static_cast<int>(std::lround(grid.row(v)));
        EXPECT_NEAR(scene.temperature.at<double>(row, column), 1500 + 2e6 * v + 1e6 * u,
                    disorder > 0 ? 12 : 5);
        EXPECT_NEAR(scene.emissivity.at<double>(row, column), u > 0 ? 0.2 : 0.3, 1e-12);
      }
    // The outline: the cells end at z = 0, and what is beyond the block is no metal.
    for (double u = -250e-6; u < 250e-6; u += 7e-6) {
      const int column = static_cast<int>(std::lround(grid.column(u)));
      int row = 0;
      while (std::isnan(scene.temperature.at<double>(row, column))) ++row;
      EXPECT_NEAR(grid.v(row - 0.5), 0, disorder > 0 ? 5e-6 : 2e-6);
    }
    EXPECT_TRUE(std::isnan(scene.temperature.at<double>(static_cast<int>(grid.row(-60e-6)),
                                                        static_cast<int>(grid.column(400e-6)))));
  }
}

// A cold wall before the plane is cut away; a hot bead behind a hole is seen through it.
TEST(Section, IsTheFirstMetalAtOrBehindThePlane) {
  CameraSettings settings;
  const SceneGrid grid(settings, 0, 0);
  ParticleSnapshot s = block(10e-6, 0, -60e-6);
  for (std::size_t i = 0; i < s.temperature.size(); ++i)
    s.temperature[i] = s.position[3 * i + 1] < 0 ? 300 : 1000;
  for (const double dx : {-15e-6, -5e-6, 5e-6, 15e-6})
    for (const double dz : {-15e-6, -5e-6, 5e-6, 15e-6}) {  // above the plate, far behind
      s.position.insert(s.position.end(), {100e-6 + dx, 45e-6, 60e-6 + dz});
      s.temperature.push_back(2000);
      s.liquid_fraction.push_back(1);
    }
  const auto at = [&](const Scene& scene, double u, double v) {
    return scene.temperature.at<double>(static_cast<int>(std::lround(grid.row(v))),
                                        static_cast<int>(std::lround(grid.column(u))));
  };
  const Scene scene = render_section(s, settings, grid);
  EXPECT_NEAR(at(scene, -50e-6, -50e-6), 1000, 1e-9);
  EXPECT_NEAR(at(scene, 100e-6, 60e-6), 2000, 1e-9);
  EXPECT_TRUE(std::isnan(at(scene, -100e-6, 60e-6)));
  settings.section = -30e-6;  // now the wall is in front
  EXPECT_NEAR(at(render_section(s, settings, grid), -50e-6, -50e-6), 300, 1e-9);
  settings.section = 0;
  settings.look = "-y";
  const SceneGrid mirrored(settings, 0, 0);
  const Scene back = render_section(s, settings, mirrored);
  EXPECT_NEAR(back.temperature.at<double>(static_cast<int>(mirrored.row(-50e-6)),
                                          static_cast<int>(mirrored.column(-50e-6))),
              300, 1e-9);
}

// Half a track, as a run with a symmetry plane computes it, looks like the whole one.
TEST(Section, ASymmetricHalfIsEnough) {
  CameraSettings settings;
  const SceneGrid grid(settings, 0, 0);
  const Scene whole = render_section(block(10e-6, 0, -60e-6), settings, grid);
  const Scene half = render_section(block(10e-6, 0, 0), settings, grid);
  const cv::Mat known = whole.temperature == whole.temperature;
  EXPECT_EQ(cv::countNonZero(known), cv::countNonZero(half.temperature == half.temperature));
  EXPECT_LT(cv::norm(whole.temperature, half.temperature, cv::NORM_INF, known), 1e-9);
}

TEST(VisiblePool, IsTheLargestConnectedPart) {
  CameraSettings settings;
  const SceneGrid grid(settings, 0, 0);
  const Scene scene = render_scene(
      [](double u, double v) {
        const bool pool = std::abs(u) < 150e-6 && v < 0 && v > -80e-6;
        const bool spatter = std::hypot(u - 300e-6, v - 100e-6) < 15e-6;
        return RayHit{pool || spatter ? 1700.0 : 500.0, 0.3};
      },
      grid);
  const VisiblePool pool = visible_pool(scene, grid, 1673);
  EXPECT_NEAR(pool.length, 300e-6, grid.step());
  EXPECT_NEAR(pool.depth, 80e-6, grid.step());
  EXPECT_EQ(visible_pool(scene, grid, 1800).length, 0);
}

}  // namespace
}  // namespace meltproof::imaging

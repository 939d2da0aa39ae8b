// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/contour.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "imaging/radiometry/radiometry.hpp"

namespace meltproof::imaging {
namespace {

/// The temperature around a point source that moves in +x at speed v over a half space (Rosenthal
/// 1946).
struct Rosenthal {
  double ambient = 300, conductivity = 30, diffusivity = 5.5e-6, speed = 0.375, power = 60;
  double operator()(double x, double y) const {
    const double r = std::max(std::hypot(x, y), 1e-9);
    return ambient + power / (2 * std::numbers::pi * conductivity * r) *
                         std::exp(-speed * (r + x) / (2 * diffusivity));
  }
};
constexpr double melting = 1673.15, pool_length = 261.80e-6, pool_width = 131.74e-6,
                 pixel = 17.6e-6;

struct Image {
  std::size_t width, height;
  std::vector<float> values;
};

template <class Field>
Image sample(std::size_t width, std::size_t height, Field field) {
  Image image{width, height, std::vector<float>(width * height)};
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x)
      image.values[y * width + x] =
          static_cast<float>(field(static_cast<double>(x), static_cast<double>(y)));
  return image;
}

Region region_of(const Image& image, double level, Interpolation interpolation = {}) {
  return RegionFinder(image.width, image.height, interpolation)
      .largest(image.values, level)
      .value();
}

TEST(Rosenthal, PoolOfTheTestHasThePublishedSize) {
  // On the axis behind the source exp(0) = 1, so the tail's end follows in closed form.
  const Rosenthal field;
  EXPECT_NEAR(field(-pool_length + 30e-6, 0), melting, 2);
  double low = -400e-6, high = 0, half_width = 0;
  for (double x = low; x < 50e-6; x += 1e-8)
    if (field(x, 0) >= melting) {
      low = std::min(low == -400e-6 ? x : low, x);
      high = std::max(high, x);
    }
  for (double x = -230e-6; x < 30e-6; x += 1e-6)
    for (double y = 0; y < 80e-6; y += 1e-8)
      if (field(x, y) >= melting) half_width = std::max(half_width, y);
  EXPECT_NEAR(high - low, pool_length, 0.05e-6);
  EXPECT_NEAR(2 * half_width, pool_width, 0.05e-6);
}

/// Relative errors of the pool's length over random positions of the grid of pixels.
template <class Measure>
std::vector<double> length_errors(Measure measure) {
  std::mt19937_64 random(20240607);
  std::uniform_real_distribution<double> offset(-0.5, 0.5);
  std::vector<double> errors;
  for (int i = 0; i < 500; ++i) {
    const double dx = offset(random), dy = offset(random);
    const auto image = sample(30, 15, [&](double x, double y) {
      return Rosenthal{}((x - 20 + dx) * pixel, (y - 7 + dy) * pixel);
    });
    errors.push_back(measure(image) * pixel / pool_length - 1);
  }
  return errors;
}

double mean(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x;
  return sum / static_cast<double>(v.size());
}

TEST(Contour, MeasuresTheRosenthalPoolWithinOneAndAHalfPerCentOfItsLength) {
  const auto temperature = length_errors(
      [](const Image& image) { return region_of(image, melting, {.logarithmic = true}).x.size(); });
  for (const double e : temperature) ASSERT_LT(std::abs(e), 0.015);
  EXPECT_LT(std::abs(mean(temperature)), 0.005);

  // The same from the signal of a camera between 3 and 5 um with a dark level of 900 counts.
  const Radiometry camera{
      .transmission = 0.313, .emissivity = 0.3, .gain = 1, .dark = 900, .integration_time = 1};
  const BandTable table(camera.band_lower, camera.band_upper);
  const double level = signal(camera, melting);
  const auto counts = length_errors([&](Image image) {
    for (auto& v : image.values)
      v = static_cast<float>(
          signal(camera, table, std::min(static_cast<double>(v), 8000.0), camera.emissivity));
    return region_of(image, level, {.logarithmic = true, .dark = camera.dark}).x.size();
  });
  for (const double e : counts) ASSERT_LT(std::abs(e), 0.015);
  EXPECT_LT(std::abs(mean(counts)), 0.006);  // 0.8 % without the parabola through the tip
}

TEST(Contour, OfPixelCentresWouldBeShortByMoreThanFivePerCent) {
  // What an outline through the centres of the pixels above the level gives: the reason for this
  // file.
  const auto errors = length_errors([](const Image& image) {
    double low = 1e9, high = -1e9;
    for (std::size_t i = 0; i < image.values.size(); ++i)
      if (image.values[i] >= melting) {
        low = std::min(low, static_cast<double>(i % image.width));
        high = std::max(high, static_cast<double>(i % image.width));
      }
    return high - low;
  });
  EXPECT_LT(mean(errors), -0.05);
  EXPECT_GT(mean(errors), -0.08);
}

TEST(Contour, IsExactForAPlane) {
  const auto image = sample(12, 9, [](double x, double) { return 10 - 1.5 * std::abs(x - 5.2); });
  const auto r = region_of(image, 4.75);
  EXPECT_NEAR(r.x.low, 5.2 - 3.5, 1e-6);
  EXPECT_NEAR(r.x.high, 5.2 + 3.5, 1e-6);
  EXPECT_TRUE(r.top);
  EXPECT_TRUE(r.bottom);
  EXPECT_FALSE(r.left);
  EXPECT_FALSE(r.right);
  EXPECT_NEAR(r.y.low, -0.5, 1e-12);  // to the outer edge of the image
  EXPECT_NEAR(r.y.high, 8.5, 1e-12);
  // Where a region meets the border its corners are cut, by at most an eighth of a pixel each.
  EXPECT_NEAR(r.area, 7.0 * 9, 0.5 + 1e-5);
  EXPECT_NEAR(r.centroid.x, 5.2, 0.02);
  EXPECT_NEAR(r.centroid.y, 4, 1e-6);
}

// Outside the image nothing is known, so the outline ends at its outer edge however values are
// interpolated; a floor for noise there would draw it in to a tenth of a pixel.
TEST(Contour, EndsAtTheOuterEdgeOfTheImageInLogarithmsToo) {
  const auto image =
      sample(12, 9, [](double x, double) { return 100 + std::exp(10 - 1.5 * std::abs(x - 5.2)); });
  RegionFinder finder(12, 9, {.logarithmic = true, .dark = 100});
  const auto r = finder.largest(image.values, 100 + std::exp(4.75));
  ASSERT_TRUE(r);
  EXPECT_NEAR(r->x.low, 5.2 - 3.5, 1e-4);
  EXPECT_NEAR(r->x.high, 5.2 + 3.5, 1e-4);
  EXPECT_NEAR(r->y.low, -0.5, 1e-12);
  EXPECT_NEAR(r->y.high, 8.5, 1e-12);
}

TEST(Contour, GivesAreaCentroidAndOrientationOfAnEllipse) {
  const double a = 9, b = 4, angle = 0.4, cx = 20.3, cy = 15.8;
  const auto image = sample(42, 32, [&](double x, double y) {
    const double u = (x - cx) * std::cos(angle) + (y - cy) * std::sin(angle);
    const double v = -(x - cx) * std::sin(angle) + (y - cy) * std::cos(angle);
    return 2 - std::hypot(u / a, v / b);
  });
  const auto r = region_of(image, 1);
  EXPECT_NEAR(r.area, std::numbers::pi * a * b, 0.01 * std::numbers::pi * a * b);
  EXPECT_NEAR(r.centroid.x, cx, 0.02);
  EXPECT_NEAR(r.centroid.y, cy, 0.02);
  EXPECT_NEAR(r.xx + r.yy, (a * a + b * b) / 4, 0.02 * (a * a + b * b) / 4);
  EXPECT_NEAR(0.5 * std::atan2(2 * r.xy, r.xx - r.yy), angle, 0.005);
  EXPECT_NEAR(r.x.size(), 2 * std::hypot(a * std::cos(angle), b * std::sin(angle)), 0.1);
  EXPECT_NEAR(r.y.size(), 2 * std::hypot(a * std::sin(angle), b * std::cos(angle)), 0.1);
  EXPECT_NEAR(r.compactness(), 1, 0.01);
  EXPECT_FALSE(r.at_border());
}

TEST(Contour, ClosesUp) {
  // Every point where a piece begins is one where another ends, also in noise full of ambiguous
  // squares.
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int trial = 0; trial < 50; ++trial) {
    const auto image = sample(20, 20, [&](double, double) { return uniform(random); });
    const auto r = region_of(image, 0.45);
    const auto order = [](const Point& p, const Point& q) {
      return std::pair(p.x, p.y) < std::pair(q.x, q.y);
    };
    std::vector<Point> from, to;
    for (const auto& s : r.edge) {
      from.push_back(s.from);
      to.push_back(s.to);
    }
    std::sort(from.begin(), from.end(), order);
    std::sort(to.begin(), to.end(), order);
    for (std::size_t i = 0; i < from.size(); ++i) {
      ASSERT_NEAR(from[i].x, to[i].x, 1e-12);
      ASSERT_NEAR(from[i].y, to[i].y, 1e-12);
    }
    EXPECT_GT(r.area, 0);
  }
}

TEST(Contour, TakesTheLargestRegionAndLeavesSpatter) {
  const auto image = sample(30, 20, [](double x, double y) {
    const double pool = 100 - 10 * std::hypot(x - 8, y - 10),
                 spatter = 500 - 200 * std::hypot(x - 24, y - 4);
    return std::max({pool, spatter, 0.0});
  });
  const auto r = region_of(image, 50);
  EXPECT_NEAR(r.centroid.x, 8, 0.05);
  EXPECT_NEAR(r.x.size(), 10, 0.1);
}

TEST(Contour, MendsADeadPixelInsideThePool) {
  auto image =
      sample(30, 20, [](double x, double y) { return 100 - 10 * std::hypot(x - 8, y - 10); });
  const double whole = region_of(image, 50).area;
  image.values[10 * 30 + 9] = std::numeric_limits<float>::quiet_NaN();
  image.values[2 * 30 + 27] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NEAR(region_of(image, 50).area, whole, 1e-6);
}

TEST(Contour, IsNothingBelowTheLevel) {
  const auto image = sample(5, 5, [](double, double) { return 3.0; });
  RegionFinder finder(5, 5, {});
  EXPECT_FALSE(finder.largest(image.values, 3.5));
  EXPECT_EQ(finder.largest(image.values, 3.0)->pixels, 25u);
}

}  // namespace
}  // namespace meltproof::imaging

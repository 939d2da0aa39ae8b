// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/front.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "imaging/meltpool/contour.hpp"

namespace meltproof::imaging {
namespace {

/// A synthetic tail: ln of the radiance falls by `slope` per pixel to the left, the emissivity
/// steps from 0.3 to 0.2 at `front`, and both are smoothed by a Gaussian of 0.8 px. The signal of
/// liquid metal at the front is 2000 above a dark level of 500.
std::vector<float> tail(double front, double slope, std::size_t width, std::size_t height) {
  std::vector<float> image(width * height);
  for (std::size_t x = 0; x < width; ++x) {
    double sum = 0, weight = 0;
    for (double u = -4; u <= 4; u += 0.01) {
      const double at = static_cast<double>(x) + u, w = std::exp(-0.5 * u * u / 0.64);
      const double cut = at > 40 ? 0 : 1;  // the leading edge
      sum += w * cut * (at > front ? 2000 : 3000) * std::exp(slope * (at - front));
      weight += w;
    }
    for (std::size_t y = 0; y < height; ++y)
      image[y * width + x] = static_cast<float>(500 + sum / weight);
  }
  return image;
}

const EmissivityStep step{500, 2500, 3500};

double end_of(const std::vector<float>& image, std::size_t width, std::size_t height) {
  std::vector<float> marked;
  if (mark_fronts(image, width, height, true, step, marked) == 0) return -1;
  RegionFinder finder(width, height, {.logarithmic = true, .dark = step.dark});
  return finder.largest(marked, step.level())->x.low;
}

TEST(Front, IsFoundToASixthOfAPixelWhereverItFallsBetweenPixels) {
  // The logarithm puts the steepest rise some 0.1 px towards the lower side. 0.13 per pixel is the
  // slope behind the pool of the paper: 104 K/px at 17.6 um and 4 um wavelength.
  for (const double slope : {0.05, 0.1, 0.13, 0.16})
    for (double front = 20; front < 21; front += 0.1)
      EXPECT_NEAR(end_of(tail(front, slope, 50, 3), 50, 3), front, 1.0 / 6) << "slope " << slope;
}

TEST(Front, IsMissedByAnyLevelAlone) {
  // Above the signal of solid metal: inside the liquid. Above that of liquid metal: outside, in the
  // solid.
  const auto image = tail(20.3, 0.13, 50, 3);
  RegionFinder finder(50, 3, {.logarithmic = true, .dark = step.dark});
  EXPECT_GT(finder.largest(image, step.solid)->x.low, 20.3 + 2);
  EXPECT_LT(finder.largest(image, step.liquid)->x.low, 20.3 - 1.5);
}

TEST(Front, IsNotInventedWhereTheEmissivityDoesNotStep) {
  std::vector<float> image(50 * 3), marked;
  for (std::size_t i = 0; i < image.size(); ++i)
    image[i] = static_cast<float>(
        500 + (i % 50 > 40 ? 0 : 2400 * std::exp(0.13 * (static_cast<double>(i % 50) - 20))));
  EXPECT_EQ(mark_fronts(image, 50, 3, true, step, marked), 0u);
  EXPECT_EQ(marked, image);
}

TEST(Front, IsFoundAlongEitherAxis) {
  const auto image = tail(20.3, 0.13, 50, 3);
  std::vector<float> turned(image.size()), marked;
  for (std::size_t y = 0; y < 3; ++y)
    for (std::size_t x = 0; x < 50; ++x) turned[x * 3 + y] = image[y * 50 + x];
  EXPECT_EQ(mark_fronts(turned, 3, 50, false, step, marked), 3u);
  RegionFinder finder(3, 50, {.logarithmic = true, .dark = step.dark});
  EXPECT_NEAR(finder.largest(marked, step.level())->y.low, 20.3, 0.12);
}

}  // namespace
}  // namespace meltproof::imaging

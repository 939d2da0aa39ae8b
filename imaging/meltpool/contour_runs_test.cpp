// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/contour_runs.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace meltproof::imaging {
namespace {

struct Marks {
  std::size_t width, height;
  std::vector<std::uint8_t> marks;
  bool at(std::ptrdiff_t x, std::ptrdiff_t y) const {
    return x >= 0 && y >= 0 && x < static_cast<std::ptrdiff_t>(width) &&
           y < static_cast<std::ptrdiff_t>(height) &&
           marks[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] != 0;
  }
};

Marks random_marks(std::mt19937_64& random, std::size_t width, std::size_t height, double density) {
  Marks m{width, height, std::vector<std::uint8_t>(width * height)};
  for (auto& v : m.marks)
    v = static_cast<double>(random() >> 11) * 0x1p-53 < density ? std::uint8_t{1} : std::uint8_t{0};
  return m;
}

/// Pixel numbers of the largest region by spreading from pixel to pixel; the rule of corners and
/// the choice among regions are those of the header.
std::vector<std::size_t> by_spreading(const Marks& m, const RunFinder::Joined& joined,
                                      const std::optional<Near>& near) {
  std::vector<std::uint8_t> seen(m.marks.size());
  std::vector<std::size_t> best;
  for (std::size_t first = 0; first < m.marks.size(); ++first) {
    if (m.marks[first] == 0 || seen[first] != 0) continue;
    std::vector<std::size_t> region{first};
    seen[first] = 1;
    double sx = 0, sy = 0;
    for (std::size_t k = 0; k < region.size(); ++k) {
      const auto x = static_cast<std::ptrdiff_t>(region[k] % m.width),
                 y = static_cast<std::ptrdiff_t>(region[k] / m.width);
      sx += static_cast<double>(x);
      sy += static_cast<double>(y);
      for (std::ptrdiff_t dy = -1; dy <= 1; ++dy)
        for (std::ptrdiff_t dx = -1; dx <= 1; ++dx) {
          if (!m.at(x + dx, y + dy)) continue;
          if (dx != 0 && dy != 0 && !m.at(x + dx, y) && !m.at(x, y + dy) &&
              !joined(static_cast<std::size_t>(std::min(x, x + dx)),
                      static_cast<std::size_t>(std::min(y, y + dy))))
            continue;
          const std::size_t i =
              static_cast<std::size_t>(y + dy) * m.width + static_cast<std::size_t>(x + dx);
          if (seen[i] != 0) continue;
          seen[i] = 1;
          region.push_back(i);
        }
    }
    const auto n = static_cast<double>(region.size());
    if (near && std::hypot(sx / n - near->place.x, sy / n - near->place.y) > near->distance)
      continue;
    if (region.size() > best.size()) best = region;
  }
  std::sort(best.begin(), best.end());
  return best;
}

std::vector<std::size_t> pixels(std::span<const Run> runs, std::size_t width) {
  std::vector<std::size_t> all;
  for (const Run& r : runs)
    for (std::ptrdiff_t x = r.begin; x < r.end; ++x)
      all.push_back(static_cast<std::size_t>(r.row) * width + static_cast<std::size_t>(x));
  return all;
}

// At every density, in narrow, low and single-row images, with corners that join never, always and
// in some squares, with and without a place that the region must be near.
TEST(Runs, AreTheLargestRegionThatSpreadingFinds) {
  std::mt19937_64 random(4711);
  RunFinder finder;
  const std::size_t sizes[][2] = {{24, 17}, {1, 30}, {30, 1}, {7, 9}, {64, 3}};
  int found = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const auto& size = sizes[trial % 5];
    const Marks m =
        random_marks(random, size[0], size[1], 0.05 + 0.9 * static_cast<double>(trial % 19) / 18);
    const int rule = trial % 3;
    const RunFinder::Joined joined = [rule](std::size_t x, std::size_t y) {
      return rule == 0 ? false : rule == 1 ? true : (x * 7 + y * 3) % 5 < 2;
    };
    std::optional<Near> near;
    if (trial % 4 == 0)
      near = Near{{0.5 * static_cast<double>(size[0]), 0.5 * static_cast<double>(size[1])},
                  0.2 * static_cast<double>(size[0] + size[1])};
    const auto expected = by_spreading(m, joined, near);
    ASSERT_EQ(pixels(finder.largest(m.marks, m.width, joined, near), m.width), expected)
        << "trial " << trial;
    found += expected.empty() ? 0 : 1;
  }
  EXPECT_GT(found, 2500);
}

TEST(Runs, AreThoseOfTheFirstAmongEqualRegions) {
  RunFinder finder;
  const std::vector<std::uint8_t> marks = {0, 1, 1, 0, 1, 1, 0};
  const auto runs = finder.largest(
      marks, 7, [](auto, auto) { return false; }, std::nullopt);
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(runs[0].begin, 1);
  EXPECT_TRUE(
      finder
          .largest(
              std::vector<std::uint8_t>(7, 0), 7, [](auto, auto) { return true; }, std::nullopt)
          .empty());
}

}  // namespace
}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/contour.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace meltproof::imaging {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Sums of a polygon's moments over its directed edges (Green's theorem): their order does not
/// matter, so the contour need not be linked.
struct Moments {
  double a = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  void add(const Point& p, const Point& q) {
    const double c = p.x * q.y - q.x * p.y;
    a += c / 2;
    x += (p.x + q.x) * c / 6;
    y += (p.y + q.y) * c / 6;
    xx += (p.x * p.x + p.x * q.x + q.x * q.x) * c / 12;
    yy += (p.y * p.y + p.y * q.y + q.y * q.y) * c / 12;
    xy += (p.x * q.y + 2 * p.x * p.y + 2 * q.x * q.y + q.x * p.y) * c / 24;
  }
};

/// The outermost crossing in each row (or column), and from them the end of the region.
class End {
 public:
  End(std::ptrdiff_t first_row, std::ptrdiff_t rows)
      : first_(first_row), outermost_(static_cast<std::size_t>(rows), -infinity) {}
  void add(std::ptrdiff_t row, double position) {
    auto& value = outermost_[static_cast<std::size_t>(row - first_)];
    value = std::max(value, position);
  }
  double position(double outermost_point) const {
    const auto it = std::max_element(outermost_.begin(), outermost_.end());
    double end = std::max(outermost_point, *it);
    if (it == outermost_.begin() || it + 1 == outermost_.end()) return end;
    const double before = it[-1], at = it[0], after = it[1];
    const double curvature = before - 2 * at + after;
    // Without crossings in both neighbours, or where the end is flat, there is nothing to refine.
    if (!std::isfinite(curvature) || curvature >= 0) return end;
    const double tip = at - (before - after) * (before - after) / (8 * curvature);
    return std::max(end, std::min(tip, at + 0.5));
  }

 private:
  std::ptrdiff_t first_;
  std::vector<double> outermost_;
};

}  // namespace

double Region::compactness() const {
  const double determinant = xx * yy - xy * xy;
  // A uniform ellipse has the area 4 pi sqrt(det M).
  return determinant > 0 ? area / (4 * std::numbers::pi * std::sqrt(determinant)) : 0;
}

RegionFinder::RegionFinder(std::size_t width, std::size_t height, Interpolation interpolation)
    : width_(static_cast<std::ptrdiff_t>(width)),
      height_(static_cast<std::ptrdiff_t>(height)),
      interpolation_(interpolation),
      labels_(width * height) {}

void RegionFinder::mend(std::span<const float> values, float level) {
  values_ = values;
  // A loop without branches, as wide as a float, since almost no frame has any.
  std::int32_t any = 0;
  for (const float v : values) any |= v != v ? 1 : 0;
  if (any == 0) return;
  bool copied = false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isnan(values[i])) continue;
    if (!copied) mended_.assign(values.begin(), values.end());
    copied = true;
    const auto x = static_cast<std::ptrdiff_t>(i) % width_,
               y = static_cast<std::ptrdiff_t>(i) / width_;
    float sum = 0;
    int above = 0;
    for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      if (x + dx < 0 || x + dx >= width_ || y + dy < 0 || y + dy >= height_) continue;
      const float v = values[static_cast<std::size_t>((y + dy) * width_ + x + dx)];
      if (v >= level) {
        sum += v;
        ++above;
      }
    }
    mended_[i] =
        above >= 3 ? sum / static_cast<float>(above) : -std::numeric_limits<float>::infinity();
  }
  if (copied) values_ = mended_;
}

/// How far the level lies from the inner pixel towards the outer one, 0 to 1.
double RegionFinder::crossing(float inside, float outside, double level) const {
  double a = static_cast<double>(inside), b = static_cast<double>(outside), l = level;
  if (interpolation_.logarithmic) {
    l = level - interpolation_.dark;
    // Noise takes the outer pixel to or below dark; a thousandth of the level keeps its logarithm
    // finite.
    const double floor = 1e-3 * l;
    a = std::log(a - interpolation_.dark);
    b = std::log(std::max(b - interpolation_.dark, floor));
    l = log_level_;
  }
  if (!std::isfinite(b)) return 0.5;
  return a > b ? std::clamp((a - l) / (a - b), 0.0, 1.0) : 0.0;
}

/// Whether the mean of the square with upper left corner (x, y) is above the level.
bool RegionFinder::joined(std::size_t x, std::size_t y, float level) const {
  const std::size_t w = static_cast<std::size_t>(width_), i = y * w + x;
  const std::array<double, 4> v = {
      static_cast<double>(values_[i]), static_cast<double>(values_[i + 1]),
      static_cast<double>(values_[i + w]), static_cast<double>(values_[i + w + 1])};
  double sum = 0, l = static_cast<double>(level);
  if (!interpolation_.logarithmic) {
    for (const double value : v) sum += value;
    return sum >= 4 * l;
  }
  l -= interpolation_.dark;
  for (const double value : v) sum += std::log(std::max(value - interpolation_.dark, 1e-3 * l));
  return sum >= 4 * std::log(l);
}

void RegionFinder::flood(std::size_t seed, std::int32_t label, float level) {
  pixels_.clear();
  stack_.assign(1, seed);
  labels_[seed] = label;
  while (!stack_.empty()) {
    const std::size_t i = stack_.back();
    stack_.pop_back();
    pixels_.push_back(i);
    const auto x = static_cast<std::ptrdiff_t>(i) % width_,
               y = static_cast<std::ptrdiff_t>(i) / width_;
    for (std::ptrdiff_t dy = -1; dy <= 1; ++dy)
      for (std::ptrdiff_t dx = -1; dx <= 1; ++dx) {
        if (x + dx < 0 || x + dx >= width_ || y + dy < 0 || y + dy >= height_) continue;
        const auto j = static_cast<std::size_t>((y + dy) * width_ + x + dx);
        if (labels_[j] != 0 || !(values_[j] >= level)) continue;
        if (dx != 0 && dy != 0 &&
            !joined(static_cast<std::size_t>(std::min(x, x + dx)),
                    static_cast<std::size_t>(std::min(y, y + dy)), level))
          continue;
        labels_[j] = label;
        stack_.push_back(j);
      }
  }
}

Region RegionFinder::outline(std::int32_t label, float level) {
  std::ptrdiff_t x0 = width_, x1 = -1, y0 = height_, y1 = -1;
  for (const std::size_t i : largest_) {
    const auto x = static_cast<std::ptrdiff_t>(i) % width_,
               y = static_cast<std::ptrdiff_t>(i) / width_;
    x0 = std::min(x0, x);
    x1 = std::max(x1, x);
    y0 = std::min(y0, y);
    y1 = std::max(y1, y);
  }
  Region region;
  region.pixels = largest_.size();
  region.left = x0 == 0;
  region.right = x1 == width_ - 1;
  region.top = y0 == 0;
  region.bottom = y1 == height_ - 1;

  const auto value = [&](std::ptrdiff_t x, std::ptrdiff_t y) {
    const bool within = x >= 0 && x < width_ && y >= 0 && y < height_;
    return within ? values_[static_cast<std::size_t>(y * width_ + x)]
                  : -std::numeric_limits<float>::infinity();
  };
  const auto inside = [&](std::ptrdiff_t x, std::ptrdiff_t y) {
    return x >= 0 && x < width_ && y >= 0 && y < height_ &&
           labels_[static_cast<std::size_t>(y * width_ + x)] == label;
  };
  // The origin of the moments is near the region, so that they lose no digits.
  const Point origin{static_cast<double>(x0), static_cast<double>(y0)};
  Moments moments;
  End right(y0, y1 - y0 + 1), left(y0, y1 - y0 + 1), down(x0, x1 - x0 + 1), up(x0, x1 - x0 + 1);
  Extent x_points{infinity, -infinity}, y_points{infinity, -infinity};

  constexpr std::array<std::pair<int, int>, 4> corner = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  for (std::ptrdiff_t y = y0 - 1; y <= y1; ++y) {
    // Corner 1 and 2 of a square are corner 0 and 3 of the next one.
    bool upper = inside(x0 - 1, y), lower = inside(x0 - 1, y + 1);
    for (std::ptrdiff_t x = x0 - 1; x <= x1; ++x) {
      const bool upper_right = inside(x + 1, y), lower_right = inside(x + 1, y + 1);
      const std::array<bool, 4> in = {upper, upper_right, lower_right, lower};
      upper = upper_right;
      lower = lower_right;
      const int count = in[0] + in[1] + in[2] + in[3];
      if (count == 0 || count == 4) continue;
      // Walking round the square, `leaves` are where the walk leaves the region, `enters` where it
      // comes back; the region's edge goes from a leaving point to the next entering one.
      std::array<Point, 2> leaves, enters;
      std::size_t n_leaves = 0, n_enters = 0;
      bool starts_inside = in[0];
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t next = (k + 1) % 4;
        if (in[k] == in[next]) continue;
        const std::size_t a = in[k] ? k : next, b = in[k] ? next : k;
        const std::ptrdiff_t ax = x + corner[a].first, ay = y + corner[a].second;
        const std::ptrdiff_t bx = x + corner[b].first, by = y + corner[b].second;
        const double t = crossing(value(ax, ay), value(bx, by), static_cast<double>(level));
        const Point p{static_cast<double>(ax) + t * static_cast<double>(bx - ax),
                      static_cast<double>(ay) + t * static_cast<double>(by - ay)};
        if (ay == by) {
          right.add(ay, p.x);
          left.add(ay, -p.x);
        } else {
          down.add(ax, p.y);
          up.add(ax, -p.y);
        }
        x_points = {std::min(x_points.low, p.x), std::max(x_points.high, p.x)};
        y_points = {std::min(y_points.low, p.y), std::max(y_points.high, p.y)};
        (in[k] ? leaves[n_leaves++] : enters[n_enters++]) = p;
      }
      const auto connect = [&](const Point& from, const Point& to) {
        region.edge.push_back({from, to});
        moments.add({from.x - origin.x, from.y - origin.y}, {to.x - origin.x, to.y - origin.y});
      };
      if (n_leaves == 1) {
        connect(leaves[0], enters[0]);
      } else {
        // Two opposite corners. With corner 0 inside the walk is leave 0, enter 0, leave 1, enter
        // 1, else enter 0, leave 0, enter 1, leave 1.
        const bool band = joined(static_cast<std::size_t>(x), static_cast<std::size_t>(y), level);
        const std::size_t after_first =
            starts_inside ? 0 : 1;  // the entering point after leaves[0]
        const std::size_t partner = band ? after_first : 1 - after_first;
        connect(leaves[0], enters[partner]);
        connect(leaves[1], enters[1 - partner]);
      }
    }
  }
  region.x = {-left.position(-x_points.low), right.position(x_points.high)};
  region.y = {-up.position(-y_points.low), down.position(y_points.high)};
  region.area = moments.a;
  if (moments.a > 0) {
    const double cx = moments.x / moments.a, cy = moments.y / moments.a;
    region.centroid = {origin.x + cx, origin.y + cy};
    region.xx = moments.xx / moments.a - cx * cx;
    region.yy = moments.yy / moments.a - cy * cy;
    region.xy = moments.xy / moments.a - cx * cy;
  }
  return region;
}

std::optional<Region> RegionFinder::largest(std::span<const float> values, double level) {
  return find(values, level, nullptr, 0);
}

std::optional<Region> RegionFinder::largest_near(std::span<const float> values, double level,
                                                 Point place, double distance) {
  return find(values, level, &place, distance);
}

std::optional<Region> RegionFinder::find(std::span<const float> values, double level,
                                         const Point* place, double distance) {
  const auto threshold = static_cast<float>(level);
  log_level_ = std::log(static_cast<double>(threshold) - interpolation_.dark);
  mend(values, threshold);
  std::fill(labels_.begin(), labels_.end(), 0);
  largest_.clear();
  std::int32_t label = 0, best = 0;
  const auto width = static_cast<std::size_t>(width_);
  for (std::size_t row = 0; row < values_.size(); row += width) {
    std::int32_t any = 0;  // most rows have nothing above the level, which this loop sees at once
    for (const float v : values_.subspan(row, width)) any |= v >= threshold ? 1 : 0;
    if (any == 0) continue;
    for (std::size_t i = row; i < row + width; ++i) {
      if (!(values_[i] >= threshold) || labels_[i] != 0) continue;
      flood(i, ++label, threshold);
      const auto near = [&] {
        double sx = 0, sy = 0;
        for (const std::size_t k : pixels_) {
          sx += static_cast<double>(k % width);
          sy += static_cast<double>(k / width);
        }
        const auto n = static_cast<double>(pixels_.size());
        return std::hypot(sx / n - place->x, sy / n - place->y) <= distance;
      };
      if (pixels_.size() > largest_.size() && (place == nullptr || near())) {
        largest_ = pixels_;
        best = label;
      }
    }
  }
  if (largest_.empty()) return std::nullopt;
  return outline(best, threshold);
}

}  // namespace meltproof::imaging

// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/contour_outline.hpp"

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

/// The end of a region, from the outermost crossing in each row (or column) and of all crossings.
double end_of(const std::vector<double>& outermost, double outermost_point) {
  const auto it = std::max_element(outermost.begin(), outermost.end());
  const double end = std::max(outermost_point, *it);
  if (it == outermost.begin() || it + 1 == outermost.end()) return end;
  const double before = it[-1], at = it[0], after = it[1];
  const double curvature = before - 2 * at + after;
  // Without crossings in both neighbours, or where the end is flat, there is nothing to refine.
  if (!std::isfinite(curvature) || curvature >= 0) return end;
  const double tip = at - (before - after) * (before - after) / (8 * curvature);
  return std::max(end, std::min(tip, at + 0.5));
}

/// The sides of a square: side k goes from corner k to corner k + 1, clockwise from the upper left
/// corner.
enum Side : std::uint8_t { top, right, bottom, left, none };
/// Walking round a square whose corner k is inside if bit k is set, `leaves` is the side on which
/// the walk leaves the region and `enters` the one on which it comes back. Two opposite corners,
/// 0101 and 1010 in binary, are not in the table.
struct Walk {
  Side leaves, enters;
};
constexpr std::array<Walk, 16> walks = {{{none, none},
                                         {top, left},
                                         {right, top},
                                         {right, left},
                                         {bottom, right},
                                         {none, none},
                                         {bottom, top},
                                         {bottom, left},
                                         {left, bottom},
                                         {top, bottom},
                                         {none, none},
                                         {right, bottom},
                                         {left, right},
                                         {top, right},
                                         {left, top},
                                         {none, none}}};

}  // namespace

double Region::compactness() const {
  const double determinant = xx * yy - xy * xy;
  // A uniform ellipse has the area 4 pi sqrt(det M).
  return determinant > 0 ? area / (4 * std::numbers::pi * std::sqrt(determinant)) : 0;
}

double LevelImage::log_level() const {
  return std::log(static_cast<double>(level) - interpolation.dark);
}

double LevelImage::log_above_dark(float value, bool inside) const {
  const double above = static_cast<double>(value) - interpolation.dark;
  // Outside the image, and where a pixel is dead, nothing is known: the floor is for noise only,
  // and the outline ends half way.
  if (value == -std::numeric_limits<float>::infinity()) return static_cast<double>(value);
  const double floor = 1e-3 * (static_cast<double>(level) - interpolation.dark);
  return std::log(inside ? above : std::max(above, floor));
}

bool LevelImage::joined(std::size_t x, std::size_t y) const {
  const auto w = static_cast<std::size_t>(width), i = y * w + x;
  double sum = 0;
  if (!interpolation.logarithmic) {
    for (const std::size_t k : {i, i + 1, i + w, i + w + 1}) sum += static_cast<double>(values[k]);
    return sum >= 4 * static_cast<double>(level);
  }
  for (const std::size_t k : {i, i + 1, i + w, i + w + 1}) sum += log_above_dark(values[k], false);
  return sum >= 4 * log_level();
}

float OutlineWalker::value(std::ptrdiff_t x, std::ptrdiff_t y) const {
  const bool within = x >= 0 && x < image_.width && y >= 0 && y < image_.height;
  return within ? image_.values[static_cast<std::size_t>(y * image_.width + x)]
                : -std::numeric_limits<float>::infinity();
}

/// Up to four edges of the grid meet at a pixel, and logarithms are most of the work.
double OutlineWalker::logarithm(std::ptrdiff_t x, std::ptrdiff_t y, bool inside) {
  double& log = logs_[at(x, y)];
  if (std::isnan(log)) log = image_.log_above_dark(value(x, y), inside);
  return log;
}

/// Where the level lies between a pixel inside (ax, ay) and a neighbour outside (bx, by).
Point OutlineWalker::crossing(std::ptrdiff_t ax, std::ptrdiff_t ay, std::ptrdiff_t bx,
                              std::ptrdiff_t by) {
  double a = 0, b = 0, level = static_cast<double>(image_.level);
  if (image_.interpolation.logarithmic) {
    a = logarithm(ax, ay, true);
    b = logarithm(bx, by, false);
    level = log_level_;
  } else {
    a = static_cast<double>(value(ax, ay));
    b = static_cast<double>(value(bx, by));
  }
  double t = 0.5;
  if (std::isfinite(b)) t = a > b ? std::clamp((a - level) / (a - b), 0.0, 1.0) : 0.0;
  return {static_cast<double>(ax) + t * static_cast<double>(bx - ax),
          static_cast<double>(ay) + t * static_cast<double>(by - ay)};
}

Region OutlineWalker::walk(const LevelImage& image, std::span<const Run> runs, bool with_edge) {
  image_ = image;
  std::ptrdiff_t x0 = image.width, x1 = -1;
  const std::ptrdiff_t y0 = runs.front().row, y1 = runs.back().row;
  Region region;
  for (const Run& run : runs) {
    x0 = std::min(x0, run.begin);
    x1 = std::max(x1, run.end - 1);
    region.pixels += static_cast<std::size_t>(run.end - run.begin);
  }
  region.left = x0 == 0;
  region.right = x1 == image.width - 1;
  region.top = y0 == 0;
  region.bottom = y1 == image.height - 1;

  // The window has a border of one pixel outside the region, which may lie outside the image too.
  x0_ = x0 - 1;
  y0_ = y0 - 1;
  window_ = x1 - x0 + 3;
  const auto columns = static_cast<std::size_t>(x1 - x0 + 1),
             rows = static_cast<std::size_t>(y1 - y0 + 1);
  const std::size_t window = (columns + 2) * (rows + 2);
  inside_.assign(window, 0);
  for (const Run& run : runs)
    std::fill_n(inside_.begin() + static_cast<std::ptrdiff_t>(at(run.begin, run.row)),
                run.end - run.begin, std::uint8_t{1});
  if (image.interpolation.logarithmic) {
    log_level_ = image.log_level();
    logs_.assign(window, std::numeric_limits<double>::quiet_NaN());
  }
  below_.resize(columns + 2);
  for (auto* ends : {&right_, &left_}) ends->assign(rows, -infinity);
  for (auto* ends : {&down_, &up_}) ends->assign(columns, -infinity);

  // The origin of the moments is near the region, so that they lose no digits.
  const Point origin{static_cast<double>(x0), static_cast<double>(y0)};
  Moments moments;
  Extent x_points{infinity, -infinity}, y_points{infinity, -infinity};
  const auto extend = [&](const Point& p) {
    x_points = {std::min(x_points.low, p.x), std::max(x_points.high, p.x)};
    y_points = {std::min(y_points.low, p.y), std::max(y_points.high, p.y)};
  };
  const auto outer = [](double& end, double position) { end = std::max(end, position); };
  const auto connect = [&](const Point& from, const Point& to) {
    if (with_edge) region.edge.push_back({from, to});
    moments.add({from.x - origin.x, from.y - origin.y}, {to.x - origin.x, to.y - origin.y});
  };
  for (std::ptrdiff_t y = y0_; y <= y1; ++y) {
    const std::uint8_t* const upper = &inside_[at(x0_, y)];
    const std::uint8_t* const lower = upper + window_;
    std::array<Point, 4> side;  // where the edge crosses it, if it does
    for (std::ptrdiff_t column = 0; column + 1 < window_; ++column) {
      const int corners =
          upper[column] | upper[column + 1] << 1 | lower[column + 1] << 2 | lower[column] << 3;
      if (corners == 0 || corners == 15) continue;
      const std::ptrdiff_t x = x0_ + column;
      // What crosses the upper side was found in the row above, and the left side in the square
      // before: either has crossings on the same side, so it was not passed over.
      side[top] = below_[static_cast<std::size_t>(column)];
      side[left] = side[right];
      if (upper[column + 1] != lower[column + 1]) {
        const bool down = upper[column + 1] != 0;  // the way out of the region
        const Point p = down ? crossing(x + 1, y, x + 1, y + 1) : crossing(x + 1, y + 1, x + 1, y);
        outer(down_[static_cast<std::size_t>(column)], p.y);
        outer(up_[static_cast<std::size_t>(column)], -p.y);
        extend(p);
        side[right] = p;
      }
      if (lower[column] != lower[column + 1]) {
        const bool outwards = lower[column] != 0;  // towards higher columns
        const Point p =
            outwards ? crossing(x, y + 1, x + 1, y + 1) : crossing(x + 1, y + 1, x, y + 1);
        outer(right_[static_cast<std::size_t>(y + 1 - y0)], p.x);
        outer(left_[static_cast<std::size_t>(y + 1 - y0)], -p.x);
        extend(p);
        below_[static_cast<std::size_t>(column)] = side[bottom] = p;
      }
      const Walk& walk = walks[static_cast<std::size_t>(corners)];
      if (walk.leaves != none) {
        connect(side[walk.leaves], side[walk.enters]);
        continue;
      }
      // Two opposite corners: either a band joins them, or the edge cuts off each.
      const bool band = image.joined(static_cast<std::size_t>(x), static_cast<std::size_t>(y));
      if (corners == 5) {
        connect(side[top], side[band ? right : left]);
        connect(side[bottom], side[band ? left : right]);
      } else {
        connect(side[right], side[band ? bottom : top]);
        connect(side[left], side[band ? top : bottom]);
      }
    }
  }
  region.x = {-end_of(left_, -x_points.low), end_of(right_, x_points.high)};
  region.y = {-end_of(up_, -y_points.low), end_of(down_, y_points.high)};
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

}  // namespace meltproof::imaging

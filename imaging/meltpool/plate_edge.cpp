// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/plate_edge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include <Eigen/Dense>

namespace meltproof::imaging {
namespace {

double cumulative(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

struct ColumnEdge {
  double row = 0, ratio = 0;  // ratio: signal at the border over the largest of the column
};

/// The border of one column, by least squares for every row on a grid of a fiftieth of a line.
std::optional<ColumnEdge> fit_column(const std::vector<double>& s, double sigma) {
  const auto n = static_cast<int>(s.size());
  const int top = static_cast<int>(std::max_element(s.begin(), s.end()) - s.begin());
  int half = top;
  while (half > 0 && s[static_cast<std::size_t>(half - 1)] > 0.5 * s[static_cast<std::size_t>(top)])
    --half;
  if (half < 2) return std::nullopt;
  double least = std::numeric_limits<double>::infinity();
  ColumnEdge best;
  for (double row = half - 1.5; row <= half + 1.0; row += 0.02) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    const int first = std::max(0, half - 4), last = std::min(n - 1, half + 3);
    const auto basis = [&](int i) {
      const double d = i - row, metal = cumulative(d / sigma);
      return Eigen::Vector3d(metal, metal * d, metal * d * d);
    };
    for (int i = first; i <= last; ++i) {
      const Eigen::Vector3d b = basis(i);
      normal += b * b.transpose();
      right += s[static_cast<std::size_t>(i)] * b;
    }
    const Eigen::Vector3d p = normal.ldlt().solve(right);
    double squares = 0;
    for (int i = first; i <= last; ++i)
      squares += std::pow(s[static_cast<std::size_t>(i)] - basis(i).dot(p), 2);
    if (squares < least) {
      least = squares;
      best = {row, p(0) / s[static_cast<std::size_t>(top)]};
    }
  }
  return best;
}

}  // namespace

PlateEdge find_plate_edge(const Stack& stack, double dark, double level, const Blur& blur) {
  const std::vector<float> image = smoothed(stack, 0.5, 0);
  std::vector<double> rows, ratios, column(stack.lines);
  for (std::size_t c = 0; c < stack.columns; c += 2) {
    double highest = 0;
    for (std::size_t l = 0; l < stack.lines; ++l) {
      column[l] = static_cast<double>(image[l * stack.columns + c]) - dark;
      highest = std::max(highest, column[l]);
    }
    if (!(highest >= level - dark)) continue;
    if (const auto edge = fit_column(column, blur.across)) {
      rows.push_back(edge->row);
      ratios.push_back(edge->ratio);
    }
  }
  PlateEdge edge;
  if (rows.size() < 8) return edge;
  const auto part = [](std::vector<double> v, double q) {
    std::sort(v.begin(), v.end());
    return v[static_cast<std::size_t>(q * static_cast<double>(v.size() - 1))];
  };
  edge.row = part(rows, 0.5);
  const double spread = 0.5 * (part(rows, 0.84) - part(rows, 0.16));
  // Columns next to each other share the blur: a column in four pixels is its own witness.
  edge.u_row = std::hypot(
      spread / std::sqrt(std::max(1.0, static_cast<double>(rows.size()) / (2 * Stack::samples))),
      0.03);
  edge.present = spread < 0.35 && part(ratios, 0.5) >= 0.7;
  return edge;
}

Stack mirrored(const Stack& stack, double dark, const PlateEdge& edge, const Blur& blur) {
  const auto first = static_cast<std::ptrdiff_t>(std::ceil(edge.row - 0.2));
  const auto below = static_cast<std::ptrdiff_t>(stack.lines) - first;
  Stack whole = stack;
  const std::ptrdiff_t half = std::max<std::ptrdiff_t>(below - 1, 2);
  whole.lines = static_cast<std::size_t>(2 * half);
  whole.signal.assign(whole.lines * stack.columns, std::numeric_limits<float>::quiet_NaN());
  whole.deviation.assign(whole.lines * stack.columns, 0);
  const double floor = std::max(0.1 * stack.noise, 1e-6);
  for (std::size_t c = 0; c < stack.columns; ++c) {
    // ln of the signal of metal at line numbers; beyond the border that of the mirror image.
    const auto metal = [&](std::ptrdiff_t l) {
      if (l < first) l = static_cast<std::ptrdiff_t>(std::lround(2 * edge.row)) - l;
      l = std::clamp<std::ptrdiff_t>(l, first, static_cast<std::ptrdiff_t>(stack.lines) - 1);
      const double seen =
          static_cast<double>(stack.signal[static_cast<std::size_t>(l) * stack.columns + c]) - dark;
      const double part = cumulative((static_cast<double>(l) - edge.row) / blur.across);
      return std::log(std::max(seen / part, floor));
    };
    for (std::ptrdiff_t k = 0; k < half; ++k) {
      const double depth = static_cast<double>(k) + 0.5, at = edge.row + depth;
      const auto l = static_cast<std::ptrdiff_t>(std::floor(at));
      const double t = at - static_cast<double>(l);
      const double p0 = metal(l - 1), p1 = metal(l), p2 = metal(l + 1), p3 = metal(l + 2);
      const double value =
          p1 +
          0.5 * t * (p2 - p0 + t * (2 * p0 - 5 * p1 + 4 * p2 - p3 + t * (3 * (p1 - p2) + p3 - p0)));
      if (!std::isfinite(value)) continue;
      const auto signal = static_cast<float>(dark + std::exp(value));
      for (const std::ptrdiff_t row : {half + k, half - 1 - k}) {
        const auto i = static_cast<std::size_t>(row) * stack.columns + c;
        whole.signal[i] = signal;
        const auto source = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
                                l, 0, static_cast<std::ptrdiff_t>(stack.lines) - 1)) *
                                stack.columns +
                            c;
        whole.deviation[i] = stack.deviation[source];
      }
    }
  }
  return whole;
}

}  // namespace meltproof::imaging
